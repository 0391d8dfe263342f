package skein.lanes

/** A way by which a [[Timetable]]'s reading is carried forward: parts flown under one command each. What the
  * numbers mean, the kind of predicted vehicles says.
  */
private[skein] final class Propagation(
    val parts: Array[Propagation.Part],
    val first: Double = 0,
    val second: Double = 0
):
  /** With the places of the commands that its decisions became. */
  private[lanes] def placed(placeOf: Int => Int): Propagation =
    def place(decision: Int) = if decision == 0 then Propagation.Rest else placeOf(decision)
    Propagation(parts.map(part => part.copy(command = place(part.command))), first, second)

  /** About so much memory is held. */
  private[lanes] def bytes: Long = 48 + parts.iterator.map(part => 48L + 4 * part.numbers.length).sum

private[skein] object Propagation:
  /** Of what is not carried forward. */
  private[lanes] val Nowhere: Propagation = Propagation(Array.empty)

  /** In the place of a command: none yet. */
  val Rest: Int = -1

  /** @param command the decision that it carries, 0 where there is none yet; in a timetable its place, or
    *   [[Rest]]
    */
  final case class Part(command: Int, numbers: Array[Float])
