package skein.lanes

import skein.forward.Outcome

/** Holds a kernel's world to the scalar reference. */
private[lanes] object ScalarWitness:

  /** The largest difference of distances, m, and efforts, rad. */
  def apart(kernel: LoopDuelKernel, world: Int, reference: Outcome): Double = Vector(
    kernel.minDistance(world) - reference.minDistanceM,
    kernel.meanDistance(world) - reference.meanDistanceM,
    kernel.pursuerEffortRad(world) - reference.pursuerEffortRad,
    kernel.evaderEffortRad(world) - reference.evaderEffortRad
  ).map(_.abs).max

  /** Whether a decision lies at a threshold: the scalar engine too decides otherwise from hundredths of a millimetre
    * aside.
    *
    * @param scalar
    *   a flight that begins so many metres aside
    */
  def isAtThreshold(reference: Outcome)(scalar: Double => Outcome): Boolean =
    (-4 to 4).exists: k =>
      val from = scalar(k * 5e-6)
      Vector(
        from.minDistanceM - reference.minDistanceM,
        from.meanDistanceM - reference.meanDistanceM,
        from.pursuerEffortRad - reference.pursuerEffortRad,
        from.evaderEffortRad - reference.evaderEffortRad
      ).map(_.abs).max >= 2e-3
