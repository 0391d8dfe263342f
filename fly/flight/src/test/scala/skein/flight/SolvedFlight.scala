package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import skein.link.TcpTransport
import skein.loop.{Fallback, LoopKind, FlightOutcome}
import skein.record.MemoryRecorder
import skein.scenario.Scenarios
import skein.settings.{FlySettings, SolverChoice}
import skein.signal.LatencyProfile
import skein.solver.*
import skein.units.*

/** A live duel that only a solver decides: common to tests of the links between the two.
  *
  * @param link the link to the solver
  */
final class SolvedFlight(
    by: SolverChoice,
    link: MessageLink,
    loop: LoopKind = LoopKind.Stream,
    duration: Span = Span.ofSeconds(3),
    patience: Span = Span.ofSeconds(30),
    toldAfter: Span = Span.ofSeconds(2),
    tell: String => Unit = _ => (),
    changed: FlySettings => FlySettings = identity
)(using system: ActorSystem):
  val settings: FlySettings = changed(FlySettings(
    List(loop),
    List(LatencyProfile.none),
    duration,
    period = Span.ofMillis(100),
    seed = 7,
    fallback = Fallback.Hover,
    solver = Some(by)
  ))
  private val plan      = settings.plans.last
  private val assembler = FlightAssembler(
    TcpTransport(),
    Clock.system,
    settings,
    None,
    workers = _ => throw AssertionError("the flight's own process was to plan"),
    tell = tell,
    solvers = Solvers(SolvedFlight.Build, _ => Right(link), patience, toldAfter)
  )
  val briefing: Briefing       = Briefing.of(settings, plan)
  val recorder: MemoryRecorder = MemoryRecorder(assembler.heading(plan, "real"))

  def start(): Future[Either[String, FlightAssembly]] = assembler.start(plan, recorder)

  def flown(): Future[FlightOutcome] =
    given ExecutionContext = system.dispatcher
    start().flatMap(_.fold(why => throw AssertionError(why), _.landed)).map(_.outcome)

object SolvedFlight:
  val Build = "same"

  def desk(id: Long = 1)(using system: ActorSystem)(using Scenarios): SolverDesk = SolverDesk(
    id,
    Build,
    Briefing.plan(_).flatMap(FlightDeciders.of(_, FlightAssembler.threads)),
    Clock.system,
    system.dispatcher
  )
