package skein.lanes.timetable

/** The steps of a prediction from a reading of a [[Timetable]], as parts, each under one command. The kind of
  * vehicle defines the values of a part. One minute of a large team needs hundreds of thousands of
  * propagations.
  *
  * @param commands the decision of each part, 0 before the first one; in a timetable the slot of its command,
  *   or [[Propagation.Rest]]
  * @param numbers values of all parts, concatenated, equally many for each
  */
private[skein] final class Propagation(
    val commands: Array[Int],
    val numbers: Array[Float],
    val first: Float = 0,
    val second: Float = 0
):
  private[lanes] def perPart: Int = if commands.isEmpty then 0 else numbers.length / commands.length

  /** Replaces the decisions by the slots of their commands. */
  private[lanes] def placed(placeOf: Int => Int): Propagation =
    def place(decision: Int) = if decision == 0 then Propagation.Rest else placeOf(decision)
    Propagation(commands.map(place), numbers, first, second)

  /** Approximate size in memory, bytes, for [[Timetables]]. */
  private[lanes] def bytes: Long = 64 + 4L * (commands.length + numbers.length)

private[skein] object Propagation:
  /** The empty propagation, which ends at the reading itself. */
  val Nothing: Propagation = Propagation(Array.empty, Array.empty)

  val Rest: Int = -1
