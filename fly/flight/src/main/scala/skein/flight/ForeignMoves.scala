package skein.flight

import skein.record.{Acknowledgement, CommandOutcome, CommandRow}
import skein.units.{Instant, Span}

/** Whether another client moves a vehicle of the flight. A simulator answers false to a move that another one
  * replaced, or whose time was over. If the flight itself has sent no other since, and its time was not over,
  * the other one was a stranger's. Pure.
  *
  * @param newest sequence and time of the flight's newest move of the vehicle
  * @param replaced whether a stranger's move replaced each of the [[ForeignMoves.Judged]] moves that ended
  *   last
  */
private[flight] final case class ForeignMoves(
    newest: Option[(Long, Instant)] = None,
    replaced: Vector[Boolean] = Vector.empty
):
  def sent(move: CommandRow): ForeignMoves = copy(newest = Some(move.sequence -> move.sentAt))

  /** @param lasts duration of the flight's moves */
  def ended(move: Acknowledgement, lasts: Span): ForeignMoves =
    val isForeign = move.outcome == CommandOutcome.Superseded && newest.exists: (sequence, sentAt) =>
      sequence == move.command && move.endedAt.since(sentAt) < lasts
    copy(replaced = (replaced :+ isForeign).takeRight(ForeignMoves.Judged))

  /** Few are no sign: after a lost answer, the flight itself ends its newest move
    * ([[skein.airsim.MoveQueue]]).
    */
  def areMany: Boolean = replaced.count(identity) >= ForeignMoves.Many

private[flight] object ForeignMoves:
  val Judged = 10
  val Many   = 5
