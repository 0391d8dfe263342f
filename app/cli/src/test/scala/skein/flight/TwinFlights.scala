package skein.flight

import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{Await, Future}
import scala.concurrent.duration.Duration
import scala.util.Using
import skein.link.TcpTransport
import skein.loop.LoopKind
import skein.measure.FlightSet
import skein.report.PaperReport
import skein.report.{Report, SummaryTables}
import skein.scenario.Scenarios
import skein.settings.{FlightPlan, FlySettings}
import skein.signal.LatencyProfile
import skein.units.*

/** Live flights over real sockets and in real time, side by side, and their twins in virtual time. */
object TwinFlights:
  private given Scenarios = PaperReport.scenarios

  /** Settings of the duel over `direct` and the given links. */
  def settings(loops: List[LoopKind], seconds: Int, more: LatencyProfile*): FlySettings = FlySettings(
    loops,
    LatencyProfile.direct :: more.toList,
    Span.ofSeconds(seconds),
    period = Span.ofMillis(100),
    seed = 1
  )

  /** Runs all flights of the settings, and each again in virtual time. Blocks for the duration of a flight.
    *
    * @param twins number of twins of each live flight
    */
  def fly(settings: FlySettings, twins: Int): Either[String, FlightSet] =
    inFolder: folder =>
      val plans  = settings.plans
      val repeat = plans.flatMap(_.twins(twins))
      for
        _ <- flyLive(settings, plans, folder)
        missing = VirtualFlights.fly(settings, repeat, folder)((_, _) => ()).missing
        _       <- Expect.that(missing.isEmpty)(NotFlown.message(missing, repeat.size))
        flights <- Report.read((plans ++ repeat).map(_.file(folder))).left.map(_.mkString("\n"))
      yield flights

  def flyLive(settings: FlySettings, plans: Vector[FlightPlan], folder: Path): Either[String, Unit] =
    given system: ActorSystem = ActorSystem("twins")
    import system.dispatcher
    val assembler = FlightAssembler(TcpTransport(), Clock.system, settings, simulator = None)
    val flying    = LiveFlights.start(assembler, plans, folder).flatMap:
      case Left(reason)   => Future.successful(Left(reason))
      case Right(flights) => flights.landed.map(_ => Right(()))
    try Await.result(flying, settings.duration.toDuration + Duration(60, "s"))
    finally
      val _ = Await.result(system.terminate(), Duration(30, "s"))

  def inFolder[A](use: Path => A): A =
    val folder = Files.createTempDirectory("twins")
    try use(folder)
    finally
      Using.resource(Files.walk(folder))(
        _.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_))
      )

/** Checks that live flights and their virtual twins agree: runs `stream` and `predictive` over `direct` and
  * `vpn` in real time for `seconds` seconds, each again in virtual time with ten seeds, and fails if the
  * converged distances differ by more than 2 %. For a quiet machine; 60 s are the experiment's own:
  * `cli/Test/runMain skein.flight.checkTwins 60`.
  */
@main def checkTwins(seconds: Int): Unit =
  val flights = TwinFlights
    .fly(
      TwinFlights.settings(List(LoopKind.Stream, LoopKind.Predictive), seconds, LatencyProfile.vpn),
      twins = 10
    )
    .fold(sys.error(_), identity)
  println(s"${SummaryTables.twinsNote}\n${SummaryTables.twins(flights).render}")
  val apart = flights.twins.filterNot(_.difference.exists(_.abs <= 0.02))
  if apart.nonEmpty then sys.error(s"more than 2 % apart: ${apart.map(_.live.flight.id).mkString(", ")}")
