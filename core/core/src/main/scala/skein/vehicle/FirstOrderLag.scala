package skein.vehicle

/** How a velocity's error v − u dies away under v' = (u − v) / lag while u stands still: after t, e^(−t /
  * lag) of it remains. So the position has changed by u · t + (v − u) · [[carriesS]](t), where v was the
  * initial velocity.
  *
  * @param lagS 0: the velocity jumps
  */
final case class FirstOrderLag(lagS: Double):
  require(lagS >= 0, s"a lag must not be negative, came $lagS s")

  def remains(afterS: Double): Double = if lagS == 0 then 0 else StrictMath.exp(-afterS / lagS)

  /** Time in which an undiminished error would move the vehicle equally far, s: lag · (1 − e^(−t / lag)). */
  def carriesS(afterS: Double): Double = carriedS(remains(afterS))

  /** [[carriesS]], given the share that [[remains]]. */
  def carriedS(remains: Double): Double = lagS * (1 - remains)
