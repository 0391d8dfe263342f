package skein.port

import skein.units.Instant

/** The actions that a vehicle has received in [[CommandPlan]]s: the buffer beside it. Pure; plans may arrive
  * in any order, several times, or never.
  *
  * A plan replaces all actions from its first moment on. Before that moment the older plan goes on, and
  * afterwards too, where the new one never arrives.
  *
  * @tparam A an action, in whatever form the vehicle performs it
  * @param newest number of the newest plan received
  * @param actions in ascending order of their moments
  */
final case class PlanBuffer[A] private (newest: Option[Long], actions: Vector[(at: Instant, action: A)]):

  /** Adds a plan that arrives at `now`; changes nothing unless the plan is newer than all before. */
  def received(sequence: Long, plan: Vector[(at: Instant, action: A)], now: Instant): PlanBuffer[A] =
    if !isNews(sequence) then this
    else
      val kept = plan.headOption.fold(actions)(first => actions.filter(_.at < first.at))
      PlanBuffer(Some(sequence), PlanBuffer.from(kept ++ plan, now).take(PlanBuffer.Limit))

  def isNews(sequence: Long): Boolean = newest.forall(sequence > _)

  /** The action in effect: the one of the last moment that has passed. */
  def due(now: Instant): Option[(at: Instant, action: A)] = actions.takeWhile(_.at <= now).lastOption

  /** The first moment after `now` at which another action takes effect. */
  def nextAfter(now: Instant): Option[Instant] = actions.map(_.at).find(_ > now)

object PlanBuffer:
  /** Most actions held, of several plans together; of more, the latest are left out. */
  val Limit: Int = 4 * CommandPlan.Most

  def empty[A]: PlanBuffer[A] = PlanBuffer(None, Vector.empty)

  /** The actions without those whose successors are in effect too. */
  private def from[A](actions: Vector[(at: Instant, action: A)], now: Instant) =
    actions.drop(actions.lastIndexWhere(_.at <= now).max(0))
