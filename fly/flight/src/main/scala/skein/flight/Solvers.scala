package skein.flight

import skein.settings.{FlightPlan, SolverChoice}
import skein.signal.SplitMix64
import skein.solver.MessageLink
import skein.units.*

/** How flights reach solvers.
  *
  * @param build this program's build; the solver's must be equal
  * @param link makes the link to a solver, or states why there is none
  * @param patience longest wait of a flight, before its start, for a solver that accepts it
  * @param toldAfter time after which the user is informed that it waits
  */
final case class Solvers(
    build: String,
    link: SolverChoice => Either[String, MessageLink],
    patience: Span = Span.ofSeconds(30),
    toldAfter: Span = Span.ofSeconds(2)
):

  /** An identifier that no other flight has. */
  private[flight] def number(plan: FlightPlan, clock: Clock): Long =
    SplitMix64.seedOf(SplitMix64.seedOf(plan.seed, plan.id.hashCode), clock.now().toNanos)

object Solvers:
  /** No solvers: for flights whose decisions are made in this process. */
  val none: Solvers = Solvers("none", _ => Left("nobody can be asked elsewhere"))
