package skein.loop

import scala.annotation.tailrec
import skein.forecast.Course
import skein.policy.{Action, ActionGuidance, Fleet}
import skein.port.CommandPlan
import skein.units.*

/** A team's decisions, rolled forward by its own policies and the models that predict it: what each vehicle
  * will be commanded if nothing unforeseen happens. Pure.
  *
  * Each vehicle decides once a period on the predicted states of all. Their readings are assumed to keep
  * their present ages. Where the policies of others are not known, one vehicle alone decides.
  */
private final class Foreseen(fleet: Fleet, deciders: IndexedSeq[Decider], period: Span):
  import Foreseen.*

  /** The next [[CommandPlan.Most]] actions of a vehicle and of every vehicle known to decide as it does, from
    * the time of the view's estimates on; no actions of other vehicles. Cost: as many decisions of each, and
    * the predicted flight of all.
    *
    * @param view a view with estimates
    * @param minds the state with which each vehicle decides
    * @throws skein.units.OwnFailure as [[Decider.decide]]
    */
  def actions(vehicle: Int, view: TeamView, minds: Vector[Mind], now: Instant): Vector[Actions] =
    val deciding = minds.zipWithIndex.map: (mind, index) =>
      Option.when(view.knows == Knowledge.All || index == vehicle)(mind)
    val known = for forecast <- view.forecast; estimates <- view.estimates yield (forecast, estimates)
    known.fold(fleet.agents.map(_ => Vector.empty)): (forecast, estimates) =>
      rolled(view, forecast.courses(estimates, now), deciding, now, fleet.agents.map(_ => Vector.empty))

  @tailrec private def rolled(
      view: TeamView,
      courses: Vector[Course[?]],
      minds: Vector[Option[Mind]],
      now: Instant,
      soFar: Vector[Actions]
  ): Vector[Actions] =
    val made = deciders.zip(minds).toVector.map: (decider, mind) =>
      mind.map(mind => mind.decision.fold(decider.decide(mind.memory, view, now))((mind.memory, _)))
    val actions = made.map(_.map((_, decision) => decision.performed))
    val all     = soFar.lazyZip(courses).lazyZip(actions).map: (before, course, action) =>
      before ++ action.map(action => (at = course.at, action = action))
    if all.exists(_.sizeIs >= CommandPlan.Most) then all
    else
      // A vehicle that does not decide is predicted from its readings, whatever its commands.
      val flown = courses.lazyZip(actions).map: (course, action) =>
        course.flown(ActionGuidance.of(action.getOrElse(Action.Hover)), period)
      val moved = made.flatten.foldLeft(view)((view, made) => view.withMove(made._2.move(now)))
      val next  = moved.copy(
        readings = moved.readings.map(_.map(later)),
        estimates = Some(flown.map(_.estimate))
      )
      rolled(next, flown, made.map(_.map((memory, _) => Mind(memory, None))), now + period, all)

  private def later(reading: Reading): Reading =
    val state = reading.state
    reading.copy(state =
      state.copy(
        validAt = state.validAt + period,
        sentAt = state.sentAt + period,
        receivedAt = state.receivedAt + period
      )
    )

private object Foreseen:
  type Actions = Vector[(at: Instant, action: Action)]

  /** The state with which a vehicle decides.
    *
    * @param decision the decision that led to this memory, if it was made on the present view
    */
  final case class Mind(memory: Memory, decision: Option[Decision])
