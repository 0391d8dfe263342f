package skein.policy

/** Keeps several pursuers on a ring around one evader, at evenly spaced bearings.
  *
  * Slots have the pursuers' cyclic order around the evader, so their paths to the slots do not cross. The
  * ring's rotation minimises the sum of squared changes of bearing: with the bearings β in ascending order,
  * the pursuer of rank k of n gets mean(β) + (k − (n − 1)/2)·2π/n. The slots do not depend on the bearing at
  * which the order begins, so every pursuer computes equal slots by itself.
  *
  * @param evader the evader's index in the scenario; all other vehicles are pursuers
  * @param mostMps maximum commanded speed
  */
final case class Surrounding(evader: Int, ringM: Double, mostMps: Double, pursuit: Pursuit = Pursuit())
    extends Policy.Memoryless, Goal:

  override def isPlanar: Boolean = true

  def action(seen: Observation): Action =
    val slot  = slotRad(seen)
    val north = seen.northM(evader) + ringM * StrictMath.cos(slot)
    val east  = seen.eastM(evader) + ringM * StrictMath.sin(slot)
    val self  = seen.self
    seen.towards(
      pursuit.along(north, seen.northMps(evader), seen.northM(self), seen.northMps(self)),
      pursuit.along(east, seen.eastMps(evader), seen.eastM(self), seen.eastMps(self)),
      mostMps
    )

  def wanted(seen: Observation, aheadS: Double): (Double, Double) =
    val slot = slotRad(seen)
    (
      seen.northM(evader) + seen.northMps(evader) * aheadS + ringM * StrictMath.cos(slot),
      seen.eastM(evader) + seen.eastMps(evader) * aheadS + ringM * StrictMath.sin(slot)
    )

  /** Bearing of this vehicle's slot from the evader, from north towards east, rad. */
  private[policy] def slotRad(seen: Observation): Double =
    val n      = seen.count - 1
    val own    = bearing(seen, seen.self)
    var before = 0
    var sum    = 0.0
    for vehicle <- 0 until seen.count if vehicle != evader do
      val its = bearing(seen, vehicle)
      sum += its
      if its < own || its == own && vehicle < seen.self then before += 1
    sum / n + (before - (n - 1) / 2.0) * 2 * math.Pi / n

  private def bearing(seen: Observation, vehicle: Int): Double =
    StrictMath.atan2(seen.eastM(vehicle) - seen.eastM(evader), seen.northM(vehicle) - seen.northM(evader))
