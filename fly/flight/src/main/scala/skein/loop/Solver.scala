package skein.loop

import scala.concurrent.Future
import skein.policy.Action
import skein.units.*

/** Decides for the vehicles of a team instead of their policies: in another process. */
trait Solver:

  /** Requests decisions for one vehicle, or for those that plan together. A request leaves every older one
    * for these vehicles without an answer.
    *
    * @param deciders a group that never changes; no vehicle may be in two groups
    * @param remembered the last answer that was used, by which the solver finds its memory of these vehicles;
    *   absent before the first
    * @param askedAt time of the request, on the controller's clock, like `until`, after which an answer is
    *   discarded
    * @param searching time that the solver has for its search: not counted in [[delay]]
    * @return fails if no answer can be received; never completes if no answer is received in time
    */
  def ask(
      deciders: Vector[(vehicle: Int, memory: Memory)],
      remembered: Option[Solver.Remembered],
      view: TeamView,
      askedAt: Instant,
      until: Instant,
      searching: Span = Span.Zero
  ): Future[Solved]

  /** Recent time from a request to its answer, less the time for searching: commands are sent later by this.
    */
  def delay: Span

object Solver:
  /** Identifies an answer, by the start of the solver and the request. */
  final case class Remembered(solver: Long, question: Long)

/** A solver's decisions, with their times.
  *
  * @param solver identifies its start
  * @param question counts the requests for this vehicle
  * @param askedAt time of the request, on the controller's clock, like the other instants
  * @param decidedAt time of the decision, by the estimate of the solver's clock; without an estimate,
  *   `askedAt`
  * @param receivedAt time of receipt
  * @param thinking time from receipt of the request to sending of the answer
  * @param clock the controller's clock minus the solver's, as estimated at the request, with the bound of the
  *   error
  * @param begunAnew whether the solver had lost its memory of these vehicles, so that it decided as for the
  *   first time
  * @param chosen the decision for each requested vehicle
  */
final case class Solved(
    solver: Long,
    question: Long,
    askedAt: Instant,
    decidedAt: Instant,
    receivedAt: Instant,
    thinking: Span,
    clock: Option[(offset: Span, uncertainty: Span)],
    begunAnew: Boolean,
    chosen: Vector[Chosen]
)

/** The decision for one vehicle.
  *
  * @param plan the plan's data; absent if a policy decided
  */
final case class Chosen(action: Action, plan: Option[PlanReport] = None)
