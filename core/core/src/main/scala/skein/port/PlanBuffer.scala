package skein.port

import skein.units.Instant

/** The buffer on a vehicle's side of the link, with the actions that it has received in [[CommandPlan]]s.
  * Pure; plans may arrive in any order, several times, or never.
  *
  * A plan replaces all actions from its first time on. Before that time the older plan continues, and if the
  * new plan never arrives, also afterwards.
  *
  * @tparam A an action, in the form that the vehicle performs
  * @param newest number of the newest plan received
  * @param actions the actions to perform, ascending by their times
  */
final case class PlanBuffer[A] private (newest: Option[Long], actions: Vector[(at: Instant, action: A)]):

  /** Adds a plan that arrives at `now`; changes nothing unless the plan is newer than all earlier ones. */
  def received(sequence: Long, plan: Vector[(at: Instant, action: A)], now: Instant): PlanBuffer[A] =
    if !isNews(sequence) then this
    else
      val kept = plan.headOption.fold(actions)(first => actions.filter(_.at < first.at))
      PlanBuffer(Some(sequence), PlanBuffer.from(kept ++ plan, now).take(PlanBuffer.Limit))

  def isNews(sequence: Long): Boolean = newest.forall(sequence > _)

  /** The action in effect: the one with the latest time that has passed. */
  def due(now: Instant): Option[(at: Instant, action: A)] = actions.takeWhile(_.at <= now).lastOption

  /** The first time after `now` at which another action takes effect. */
  def nextAfter(now: Instant): Option[Instant] = actions.map(_.at).find(_ > now)

object PlanBuffer:
  /** Maximum number of stored actions, of all plans together; the latest beyond it are dropped. */
  val Limit: Int = 4 * CommandPlan.Most

  def empty[A]: PlanBuffer[A] = PlanBuffer(None, Vector.empty)

  /** The actions that are in effect at `now` or later. */
  private def from[A](actions: Vector[(at: Instant, action: A)], now: Instant) =
    actions.drop(actions.lastIndexWhere(_.at <= now).max(0))
