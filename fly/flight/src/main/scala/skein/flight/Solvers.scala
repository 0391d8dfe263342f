package skein.flight

import skein.settings.{FlightPlan, SolverChoice}
import skein.signal.SplitMix64
import skein.solver.MessageLink
import skein.units.*

/** How flights reach solvers.
  *
  * @param build of this program; the solver's must be the same
  * @param link to a solver, or why it cannot be had
  * @param patience for how long a flight waits before its start until a solver welcomes it
  * @param toldAfter from when on a person is told that it waits
  */
final case class Solvers(
    build: String,
    link: SolverChoice => Either[String, MessageLink],
    patience: Span = Span.ofSeconds(30),
    toldAfter: Span = Span.ofSeconds(2)
):

  /** A number for a flight that no other has. */
  private[flight] def number(plan: FlightPlan, clock: Clock): Long =
    SplitMix64.seedOf(SplitMix64.seedOf(plan.seed, plan.id.hashCode), clock.now().toNanos)

object Solvers:
  /** For flights whose decisions are made here. */
  val none: Solvers = Solvers("none", _ => Left("nobody can be asked elsewhere"))
