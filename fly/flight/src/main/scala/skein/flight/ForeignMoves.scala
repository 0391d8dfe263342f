package skein.flight

import skein.record.{Acknowledgement, CommandOutcome, CommandRow}
import skein.units.{Instant, Span}

/** Detects whether another client moves a vehicle of the flight. A simulator answers false to a move that was
  * replaced by another, or whose time had elapsed. If the flight has sent no newer move and the time was not
  * over, another client's move replaced it. Pure.
  *
  * @param newest sequence and time of the flight's newest move of the vehicle
  * @param replaced whether another client's move replaced it, for each of the last [[ForeignMoves.Judged]]
  *   ended moves
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

  /** Whether other clients replaced several of the last moves. A few replaced moves prove nothing: after a
    * lost answer, the flight itself ends its newest move ([[skein.airsim.MoveQueue]]).
    */
  def areMany: Boolean = replaced.count(identity) >= ForeignMoves.Many

private[flight] object ForeignMoves:
  val Judged = 10
  val Many   = 5
