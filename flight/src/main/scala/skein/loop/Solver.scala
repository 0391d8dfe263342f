package skein.loop

import scala.concurrent.Future
import skein.policy.Action
import skein.units.*

/** Decides for the vehicles of a team in the place of their policies here: in another process. */
trait Solver:

  /** Asks for one vehicle. A question leaves every older one of the same vehicle without an answer.
    *
    * @param remembered
    *   the answer that was used last, which tells the solver what the policy remembers; absent before the first
    * @param askedAt
    *   on the controller's clock, as `until`, from which on no answer is used
    * @return
    *   fails where no answer can come; never completes where none comes in time
    */
  def ask(
      vehicle: Int,
      memory: Memory,
      remembered: Option[Solver.Remembered],
      view: TeamView,
      askedAt: Instant,
      until: Instant
  ): Future[Solved]

  /** From a question to its answer, as it was of late: commands leave so much later. */
  def delay: Span

object Solver:
  /** An answer, by the start of the solver and the question. */
  final case class Remembered(solver: Long, question: Long)

/** What was decided elsewhere, and when.
  *
  * @param solver
  *   names the start of it
  * @param question
  *   counts the questions for this vehicle
  * @param askedAt
  *   on the controller's clock, as the other instants
  * @param decidedAt
  *   by what is known of the solver's clock; before that is known, when it was asked
  * @param receivedAt
  *   when the answer came
  * @param thinking
  *   from the question's coming there to the answer's leaving
  * @param clock
  *   the controller's clock minus the solver's, as estimated when it was asked, and the bound of the error
  * @param begunAnew
  *   whether the solver did not have the policy's memory any more, so that it decided as for the first time
  * @param speed
  *   absent where the vehicle commands its own
  * @param action
  *   absent where heading and speed say it
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
    headingRad: Double,
    speed: Option[MetresPerSecond],
    action: Option[Action]
)
