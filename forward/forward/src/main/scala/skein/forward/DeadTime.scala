package skein.forward

import java.util.Arrays.copyOf

/** Delays commands by a vehicle's dead time. At most [[DeadTime.Most]] commands may be pending. Mutable. */
private[forward] final class DeadTime(seconds: Double):
  import DeadTime.{Most, Room}
  private var atS, north, east = Array.ofDim[Double](Room)
  private var third, holds     = Array.ofDim[Double](Room)
  private var first, afterLast = 0

  def clear(): Unit =
    first = 0; afterLast = 0

  /** Adds a command that arrives at `nowS`; the other parameters are those of
    * [[skein.vehicle.SpatialPlant.step]].
    */
  def put(nowS: Double, northMps: Double, eastMps: Double, third: Double = 0, holds: Double = 0): Unit =
    if afterLast - first == atS.length then makeRoom()
    val slot = afterLast % atS.length
    atS(slot) = nowS + seconds; north(slot) = northMps; east(slot) = eastMps
    this.third(slot) = third; this.holds(slot) = holds
    afterLast += 1

  private def makeRoom(): Unit =
    val count = atS.length
    if count == Most then
      throw IllegalStateException(s"more than $Most commands within the dead time of $seconds s")
    def inOrder(ring: Array[Double]) =
      val room = copyOf(ring, 2 * count)
      for i <- 0 until count do room(i) = ring((first + i) % count)
      room
    atS = inOrder(atS); north = inOrder(north); east = inOrder(east)
    third = inOrder(third); holds = inOrder(holds)
    first = 0; afterLast = count

  /** Removes the commands that take effect up to a time, and calls `act` for each, the earliest first. */
  inline def until(timeS: Double)(inline act: (Double, Double, Double, Double, Double) => Unit): Unit =
    while hasUntil(timeS) do
      val slot = take()
      act(atOf(slot), northOf(slot), eastOf(slot), thirdOf(slot), holdsOf(slot))

  private[forward] def hasUntil(timeS: Double): Boolean =
    first < afterLast && atS(first % atS.length) <= timeS
  private[forward] def atOf(slot: Int): Double    = atS(slot)
  private[forward] def northOf(slot: Int): Double = north(slot)
  private[forward] def eastOf(slot: Int): Double  = east(slot)
  private[forward] def thirdOf(slot: Int): Double = third(slot)
  private[forward] def holdsOf(slot: Int): Double = holds(slot)
  private[forward] def take(): Int                =
    first += 1
    (first - 1) % atS.length

private object DeadTime:
  private val Room = 64
  private val Most = 1 << 16
