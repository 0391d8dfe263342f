package skein.lanes.timetable

/** The steps of a prediction from a [[Timetable]]'s reading: parts under one command each. The kind of
  * predicted vehicle defines the numbers. A minute of a large team has hundreds of thousands.
  *
  * @param commands of each part: its decision, 0 before the first; in a timetable its place, or
  *   [[Propagation.Rest]]
  * @param numbers of the parts, concatenated, an equal count for each
  */
private[skein] final class Propagation(
    val commands: Array[Int],
    val numbers: Array[Float],
    val first: Float = 0,
    val second: Float = 0
):
  private[lanes] def perPart: Int = if commands.isEmpty then 0 else numbers.length / commands.length

  /** The propagation with its decisions replaced by the places of their commands. */
  private[lanes] def placed(placeOf: Int => Int): Propagation =
    def place(decision: Int) = if decision == 0 then Propagation.Rest else placeOf(decision)
    Propagation(commands.map(place), numbers, first, second)

  /** Approximate size in memory, bytes, for the cache's limit. */
  private[lanes] def bytes: Long = 64 + 4L * (commands.length + numbers.length)

private[skein] object Propagation:
  /** The empty propagation, which ends at the reading itself. */
  val Nothing: Propagation = Propagation(Array.empty, Array.empty)

  val Rest: Int = -1
