package skein.lanes.timetable

import skein.lanes.plant.PlantLanes

/** Tells when events are, as the vehicles of one kind need to know it. Mutable. */
private[skein] trait EventClock:
  /** How many numbers tell a time. */
  def numbers: Int

  /** The [[numbers]] that tell this time, s; never earlier than the time before.
    *
    * @param acts whether a command begins to act
    */
  def tell(atS: Double, acts: Boolean, into: Array[Float], at: Int): Unit

/** How many steps end until then, and the numbers of the time since the last. A step begins with a command,
  * or with the end of another.
  *
  * @param told [[skein.lanes.plant.PlantStages.tell]] of the plant
  * @param pieceS when the first begins, s
  */
private[lanes] final class StepClock(
    lanes: PlantLanes,
    told: Double => Array[Double],
    private var pieceS: Double = 0
) extends EventClock:
  private val lengthS = lanes.plant.stepS

  def numbers: Int                                                        = StepClock.numbers(lanes)
  def tell(atS: Double, acts: Boolean, into: Array[Float], at: Int): Unit =
    var pieces = 0
    while atS > pieceS + lengthS do
      pieceS += lengthS
      pieces += 1
    into(at) = pieces.toFloat
    val numbers = told(atS - pieceS)
    for i <- numbers.indices do into(at + 1 + i) = numbers(i).toFloat
    if acts then pieceS = atS

private[lanes] object StepClock:
  /** How many numbers tell a time. */
  def numbers(lanes: PlantLanes): Int = 1 + lanes.stages.times
