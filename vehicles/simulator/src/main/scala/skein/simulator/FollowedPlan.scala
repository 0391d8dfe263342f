package skein.simulator

import skein.port.PlanBuffer
import skein.units.*
import skein.vehicle.PathFollowing

/** A multirotor's buffer of plans. It flies the action in effect as a move, as if a client had called that
  * move at the action's time.
  */
private[simulator] final class FollowedPlan:
  private var buffer  = PlanBuffer.empty[Move.Order]
  private var running = Option.empty[FollowedPlan.Running]
  private var due     = Option.empty[Instant]

  /** Time of the next turn; None if there is none before a new plan arrives. */
  def dueAt: Option[Instant] = due

  def receive(sequence: Long, plan: Move.Plan, now: Instant): Unit =
    buffer = buffer.received(sequence, plan, now)
    if due.forall(_ > now) then due = buffer.due(now).map(_ => now).orElse(buffer.nextAfter(now))

  /** Ends all plans. A plan that arrives later but is older than the newest one received has no effect. */
  def stop(now: Instant): Unit =
    val none = PlanBuffer.empty[Move.Order]
    buffer = buffer.newest.fold(none)(none.received(_, Vector.empty, now))
    running = None
    due = None

  def turn(vehicle: SimulatedMultirotor, now: Instant): Unit =
    for next <- buffer.due(now) if !running.exists(_.order eq next.action) do
      running = Some(FollowedPlan.Running(next.action, next.action(vehicle).toOption, next.at))
    val ended =
      for one <- running; move <- one.move
      yield move.turn(vehicle, now.since(one.startedAt)).performed(vehicle, now).isDefined
    if ended.contains(true) then running = running.map(_.copy(move = None))
    val again = Option.when(ended.contains(false))(now + PathFollowing.Period)
    due = (again ++ buffer.nextAfter(now)).minOption

private object FollowedPlan:
  /** The action in effect.
    *
    * @param move absent once it has ended, or if it could not be made
    * @param startedAt the planned time of the action, so that an action that arrives late ends no later
    */
  private final case class Running(order: Move.Order, move: Option[Move], startedAt: Instant)
