package skein.forward

/** Commands that wait out a vehicle's dead time. Mutable. */
private[forward] final class DeadTime(seconds: Double):
  import DeadTime.Pending
  private val atS, north, east = Array.ofDim[Double](Pending)
  private var first, afterLast = 0

  def clear(): Unit =
    first = 0; afterLast = 0

  /** A command that came at this time. */
  def put(nowS: Double, northMps: Double, eastMps: Double): Unit =
    if afterLast - first == Pending then
      throw IllegalStateException(s"more than $Pending commands within the dead time of $seconds s")
    val slot = afterLast % Pending
    atS(slot) = nowS + seconds; north(slot) = northMps; east(slot) = eastMps
    afterLast += 1

  /** Takes out what acts until a time, the first first. */
  inline def until(timeS: Double)(inline act: (Double, Double, Double) => Unit): Unit =
    while hasUntil(timeS) do
      val slot = take()
      act(atOf(slot), northOf(slot), eastOf(slot))

  private[forward] def hasUntil(timeS: Double): Boolean = first < afterLast && atS(first % Pending) <= timeS
  private[forward] def atOf(slot: Int): Double          = atS(slot)
  private[forward] def northOf(slot: Int): Double       = north(slot)
  private[forward] def eastOf(slot: Int): Double        = east(slot)
  private[forward] def take(): Int                      =
    first += 1
    (first - 1) % Pending

private object DeadTime:
  private val Pending = 64
