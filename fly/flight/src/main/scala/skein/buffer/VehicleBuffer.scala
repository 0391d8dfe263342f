package skein.buffer

import skein.port.{Moves, PlanBuffer}
import skein.simulator.PlannedMove
import skein.units.*

/** The plans of one vehicle, and the moves of it that the simulator has not answered. Pure.
  *
  * At most [[Moves.InFlight]] moves are unanswered at the simulator, but for those of clients that had sent
  * more themselves.
  *
  * @param begun the move that was sent last of the plans in effect
  * @param ours unanswered moves of the buffer; `theirs`: of clients
  * @param readyAt from when on a move may follow the last one that was sent or answered, on the machine's
  *   clock
  * @param held clients' moves that wait, the first first
  */
private[buffer] final case class VehicleBuffer(
    plans: PlanBuffer[VehicleBuffer.Due] = PlanBuffer.empty,
    begun: Option[VehicleBuffer.Due] = None,
    ours: Int = 0,
    theirs: Int = 0,
    readyAt: Instant = Instant.Epoch,
    held: Vector[Long] = Vector.empty
):
  import VehicleBuffer.*

  /** Takes a plan that arrives at `simulated`. */
  def received(sequence: Long, moves: Vector[PlannedMove], simulated: Instant): VehicleBuffer =
    val plan = moves.map(move => (at = move.at, action = Due(move, simulated)))
    copy(plans = plans.received(sequence, plan, simulated))

  /** Ends all plans. Those older than the newest received stay without effect when they come. */
  def stopped(simulated: Option[Instant]): VehicleBuffer =
    val none = PlanBuffer.empty[Due]
    copy(
      plans = plans.newest.fold(none)(none.received(_, Vector.empty, simulated.getOrElse(Instant.Epoch))),
      begun = None
    )

  /** Ends all plans and forgets their numbers. */
  def forgotten: VehicleBuffer = copy(plans = PlanBuffer.empty, begun = None)

  /** Whether some of its moves have not been sent yet. */
  def isFollowing: Boolean = plans.actions.lastOption.exists(last => !hasBegun(last.action))

  /** Whether it holds nothing that could still matter. */
  def isIdle: Boolean = this == VehicleBuffer(readyAt = readyAt)

  /** Whether a client's move may pass: it must not be a third one because of the buffer's. */
  def lets(now: Instant): Boolean = ours == 0 || ours + theirs < Moves.InFlight && now >= readyAt

  /** The move to send now, if one is due and may be sent. */
  def next(simulated: Instant, now: Instant): Option[Due] =
    dueAt(simulated).filter(_ => hasRoom && now >= readyAt)

  /** When, at the earliest, it has something to do, as long as nothing else happens.
    *
    * @param maySend whether moves of plans may be sent
    */
  def wakeAt(clock: Option[ObservedClock], maySend: Boolean, now: Instant): Option[Instant] =
    val moment =
      for
        known     <- clock.filter(_ => maySend)
        simulated <- known.shows(now)
        at        <-
          if dueAt(simulated).isDefined then Option.when(hasRoom)(readyAt)
          else plans.nextAfter(simulated).flatMap(known.comesTo)
      yield at
    (moment ++ Option.when(held.nonEmpty && ours + theirs < Moves.InFlight)(readyAt)).minOption

  def sent(due: Due, now: Instant): VehicleBuffer =
    copy(begun = Some(due), ours = ours + 1, readyAt = now + Moves.HandoverAllowed)

  /** The simulator has answered a move of the buffer. */
  def ended(now: Instant): VehicleBuffer = copy(ours = (ours - 1).max(0)).answered(now)

  /** The simulator has answered a move of a client. */
  def endedTheirs(now: Instant): VehicleBuffer = copy(theirs = (theirs - 1).max(0)).answered(now)

  private def answered(now: Instant) =
    if ours + theirs == 0 then this else copy(readyAt = readyAt.max(now + Moves.HandoverAllowed))

  private def dueAt(simulated: Instant) = plans.due(simulated).map(_.action).filterNot(isPast)

  /** Whether this move was sent, or one after it: the clock as it is known may go back by a little. */
  private def isPast(due: Due) = begun.exists(sent =>
    (sent eq due) || due.move.at < sent.move.at && plans.actions.exists(_.action eq sent)
  )

  private def hasBegun(due: Due) = begun.exists(_ eq due)

  private def hasRoom = held.isEmpty && ours + theirs < Moves.InFlight

private[buffer] object VehicleBuffer:
  /** A move of a plan, to be sent at its moment.
    *
    * @param since when its plan arrived, on the simulator's clock
    */
  final case class Due(move: PlannedMove, since: Instant)
