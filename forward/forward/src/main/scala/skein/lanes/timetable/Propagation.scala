package skein.lanes.timetable

/** A way by which a [[Timetable]]'s reading is carried forward: parts flown under one command each. What the
  * numbers mean, the kind of predicted vehicles says. A minute of a large team has hundreds of thousands.
  *
  * @param commands of each part: the decision that it carries, 0 where there is none yet; in a timetable its
  *   place, or [[Propagation.Rest]]
  * @param numbers of one part after the other, as many of each
  */
private[skein] final class Propagation(
    val commands: Array[Int],
    val numbers: Array[Float],
    val first: Float = 0,
    val second: Float = 0
):
  /** How many numbers a part has. */
  private[lanes] def perPart: Int = if commands.isEmpty then 0 else numbers.length / commands.length

  /** With the places of the commands that its decisions became. */
  private[lanes] def placed(placeOf: Int => Int): Propagation =
    def place(decision: Int) = if decision == 0 then Propagation.Rest else placeOf(decision)
    Propagation(commands.map(place), numbers, first, second)

  /** About so much memory is held. */
  private[lanes] def bytes: Long = 64 + 4L * (commands.length + numbers.length)

private[skein] object Propagation:
  /** None: at the reading itself. */
  val Nothing: Propagation = Propagation(Array.empty, Array.empty)

  /** In the place of a command: none yet. */
  val Rest: Int = -1
