package skein.vehicle

/** The decay of a velocity error v − u under v' = (u − v) / lag with constant u: after a time t, the share
  * e^(−t / lag) remains. So the position has changed by u · t + (v − u) · [[carriesS]](t), where v is the
  * initial velocity.
  *
  * @param lagS time constant, s; with 0 the velocity changes immediately
  */
final case class FirstOrderLag(lagS: Double):
  require(lagS >= 0, s"a lag must not be negative, got $lagS s")

  def remains(afterS: Double): Double = if lagS == 0 then 0 else StrictMath.exp(-afterS / lagS)

  /** Time in which the initial error alone would move the vehicle as far as the decaying error does in
    * `afterS`, s: lag · (1 − e^(−t / lag)).
    */
  def carriesS(afterS: Double): Double = carriedS(remains(afterS))

  /** [[carriesS]], computed from the share that [[remains]]. */
  def carriedS(remains: Double): Double = lagS * (1 - remains)
