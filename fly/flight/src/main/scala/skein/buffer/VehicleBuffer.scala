package skein.buffer

import skein.port.{Moves, PlanBuffer}
import skein.simulator.PlannedMove
import skein.units.*

/** The plans of one vehicle, with its unanswered moves. Pure.
  *
  * At most [[Moves.InFlight]] moves are unanswered at the simulator, unless clients sent more themselves.
  *
  * @param begun the newest sent move of the plans in effect
  * @param ours number of unanswered moves of the buffer; `theirs`: of clients
  * @param readyAt earliest time, on the machine's clock, of the move after the last sent or answered one
  * @param held tickets of the clients' moves that wait, the oldest first
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

  /** Adds a plan that arrives at `simulated`, the simulator's time. */
  def received(sequence: Long, moves: Vector[PlannedMove], simulated: Instant): VehicleBuffer =
    val plan = moves.map(move => (at = move.at, action = Due(move, simulated)))
    copy(plans = plans.received(sequence, plan, simulated))

  /** Ends all plans. Older plans that arrive later have no effect. */
  def stopped(simulated: Option[Instant]): VehicleBuffer =
    val none = PlanBuffer.empty[Due]
    copy(
      plans = plans.newest.fold(none)(none.received(_, Vector.empty, simulated.getOrElse(Instant.Epoch))),
      begun = None
    )

  /** Ends all plans and forgets their sequence numbers. */
  def forgotten: VehicleBuffer = copy(plans = PlanBuffer.empty, begun = None)

  /** Whether some moves of its plans have not been sent yet. */
  def isFollowing: Boolean = plans.actions.lastOption.exists(last => !hasBegun(last.action))

  /** Whether its state is empty, so that it can be dropped. */
  def isIdle: Boolean = this == VehicleBuffer(readyAt = readyAt)

  /** Whether a client's move may pass: the buffer's moves must not make it the third unanswered one. */
  def lets(now: Instant): Boolean = ours == 0 || ours + theirs < Moves.InFlight && now >= readyAt

  /** The move to send now, if one is due and may be sent. */
  def next(simulated: Instant, now: Instant): Option[Due] =
    dueAt(simulated).filter(_ => hasRoom && now >= readyAt)

  /** Earliest time at which it has something to do, unless another event occurs earlier.
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

  /** Whether this move or a later one was sent. The estimate of the clock may go back a little. */
  private def isPast(due: Due) = begun.exists(sent =>
    (sent eq due) || due.move.at < sent.move.at && plans.actions.exists(_.action eq sent)
  )

  private def hasBegun(due: Due) = begun.exists(_ eq due)

  private def hasRoom = held.isEmpty && ours + theirs < Moves.InFlight

private[buffer] object VehicleBuffer:
  /** A move of a plan, to be sent at its moment.
    *
    * @param since the simulator's time when its plan arrived
    */
  final case class Due(move: PlannedMove, since: Instant)
