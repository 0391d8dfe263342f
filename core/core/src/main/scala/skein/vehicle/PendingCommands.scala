package skein.vehicle

import skein.units.Span

/** The commands of a predicted vehicle with a dead time.
  *
  * @param acting the command in effect
  * @param last the last command received
  * @param coming received commands that are not in effect yet, the oldest first
  */
private[vehicle] final case class PendingCommands[C](
    acting: C,
    last: C,
    coming: Vector[PendingCommands.Coming[C]]
):
  import PendingCommands.Coming

  /** Receives a command, which may repeat the last one, and lets time pass.
    *
    * @return the commands that take effect in that time, the oldest first, and what follows
    */
  def after(command: C, deadTime: Span, span: Span): (Vector[Coming[C]], PendingCommands[C]) =
    val all          = if command == last then coming else coming :+ Coming(command, deadTime)
    val (due, later) = all.partition(_.in <= span)
    val left         = later.map(each => each.copy(in = each.in - span))
    (due, PendingCommands(due.lastOption.fold(acting)(_.command), command, left))

private[vehicle] object PendingCommands:
  /** @param in delay until the command takes effect */
  final case class Coming[C](command: C, in: Span)

  def resting[C](command: C): PendingCommands[C] = PendingCommands(command, command, Vector.empty)
