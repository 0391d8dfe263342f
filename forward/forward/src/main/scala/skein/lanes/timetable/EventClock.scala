package skein.lanes.timetable

import skein.lanes.plant.PlantLanes

/** Represents the times of events by the values that a kind of vehicle needs. Mutable. */
private[skein] trait EventClock:
  /** Number of values that represent one time. */
  def numbers: Int

  /** Writes the [[numbers]] values that represent a time, s; times must not decrease.
    *
    * @param acts whether a command takes effect at that time
    */
  def tell(atS: Double, acts: Boolean, into: Array[Float], at: Int): Unit

/** Represents a time by the number of steps that end until then, and by the values that
  * [[skein.lanes.plant.PlantStages]] needs of the time since the last step. A step begins at a command, or at
  * the end of the previous step.
  *
  * @param told [[skein.lanes.plant.PlantStages.tell]] of the plant
  * @param pieceS begin of the first step, s
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
  /** Number of values that represent one time. */
  def numbers(lanes: PlantLanes): Int = 1 + lanes.stages.times
