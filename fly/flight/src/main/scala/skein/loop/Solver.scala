package skein.loop

import scala.concurrent.Future
import skein.policy.Action
import skein.units.*

/** Decides for the vehicles of a team in the place of their policies here: in another process. */
trait Solver:

  /** Asks for one vehicle, or for those that plan together. A question leaves every older one for the same
    * without an answer.
    *
    * @param deciders always the same together, and no vehicle among others
    * @param remembered the answer that was used last, which tells the solver what it remembers of these
    *   vehicles; absent before the first
    * @param askedAt on the controller's clock, as `until`, from which on no answer is used
    * @param searching for how long the solver is to look for its answer: not counted in [[delay]]
    * @return fails where no answer can come; never completes where none comes in time
    */
  def ask(
      deciders: Vector[(vehicle: Int, memory: Memory)],
      remembered: Option[Solver.Remembered],
      view: TeamView,
      askedAt: Instant,
      until: Instant,
      searching: Span = Span.Zero
  ): Future[Solved]

  /** From a question to its answer, as it was of late, without what was meant for searching: commands leave
    * so much later.
    */
  def delay: Span

object Solver:
  /** An answer, by the start of the solver and the question. */
  final case class Remembered(solver: Long, question: Long)

/** What was decided elsewhere, and when.
  *
  * @param solver names the start of it
  * @param question counts the questions for this vehicle
  * @param askedAt on the controller's clock, as the other instants
  * @param decidedAt by what is known of the solver's clock; before that is known, when it was asked
  * @param receivedAt when the answer came
  * @param thinking from the question's coming there to the answer's leaving
  * @param clock the controller's clock minus the solver's, as estimated when it was asked, and the bound of
  *   the error
  * @param begunAnew whether the solver did not remember these vehicles any more, so that it decided as for
  *   the first time
  * @param chosen for each vehicle that was asked for
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

/** What one vehicle is to do.
  *
  * @param speed absent where the vehicle commands its own
  * @param action absent where heading and speed say it
  * @param plan how that was planned; absent where a policy decided
  */
final case class Chosen(
    headingRad: Double,
    speed: Option[MetresPerSecond],
    action: Option[Action],
    plan: Option[PlanReport] = None
)

object Chosen:
  def of(decision: Decision, plan: Option[PlanReport] = None): Chosen =
    Chosen(decision.heading.value, decision.speed, decision.action, plan)
