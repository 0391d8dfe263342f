package skein.vehicle

/** How a velocity's error v − u dies away under v' = (u − v) / lag while u stands still: after t, e^(−t /
  * lag) of it remains. So the position has come u · t + (v − u) · [[carriesS]](t) on, where v was the
  * velocity at first.
  *
  * @param lagS 0: the velocity jumps
  */
final case class FirstOrderLag(lagS: Double):
  require(lagS >= 0, s"a lag must not be negative, came $lagS s")

  /** The share of an error that remains after so long. */
  def remains(afterS: Double): Double = if lagS == 0 then 0 else StrictMath.exp(-afterS / lagS)

  /** For how long an undiminished error would carry as far, s: lag · (1 − e^(−t / lag)). */
  def carriesS(afterS: Double): Double = carriedS(remains(afterS))

  /** The same, by what [[remains]]. */
  def carriedS(remains: Double): Double = lagS * (1 - remains)
