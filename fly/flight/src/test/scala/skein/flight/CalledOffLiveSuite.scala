package skein.flight

import java.net.{InetAddress, ServerSocket}
import java.nio.file.{Files, Path}
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{Await, ExecutionContext, Future, Promise}
import scala.concurrent.duration.DurationInt
import scala.jdk.StreamConverters.*
import skein.link.{Address, TcpTransport}
import skein.loop.LoopKind
import skein.settings.{FlySettings, SolverChoice}
import skein.signal.LatencyProfile
import skein.solver.{LinkNews, MessageLink, OpenLink}
import skein.units.*

/** Flights that are called off before they begin, by the real clock and with recordings on the disk. */
class CalledOffLiveSuite extends munit.FunSuite:
  private given system: ActorSystem = ActorSystem("called-off")
  private given ExecutionContext    = system.dispatcher
  override def afterAll(): Unit     = Await.result(system.terminate(), 30.seconds): Unit
  private val folder = FunFixture[Path](_ => Files.createTempDirectory("called-off"), Files.delete(_))
  private def names(folder: Path) = Files.list(folder).toScala(Vector).map(_.getFileName.toString)
  private def settings(by: Option[SolverChoice]) =
    FlySettings(
      List(LoopKind.Stream),
      List(LatencyProfile.none),
      Span.ofSeconds(1),
      period = Span.ofMillis(100),
      seed = 7,
      solver = by
    )

  /** A link whose other side never answers. `Files.delete` of the folder fails if anything remains there. */
  private object Silent extends MessageLink:
    def open(received: Array[Byte] => Unit, news: LinkNews => Unit): OpenLink = new OpenLink:
      def send(message: Array[Byte]) = Right(())
      def close()                    = Future.successful(Done)

  folder.test("a flight called off while it waits for its solver leaves no recording"): folder =>
    val requests  = OutsideRequests()
    val waits     = Promise[Unit]()
    val flown     = settings(Some(SolverChoice.Tcp(Address("127.0.0.1", 9))))
    val assembler = FlightAssembler(
      TcpTransport(),
      Clock.system,
      flown,
      None,
      tell = _ => waits.trySuccess(()): Unit,
      calledOff = requests.calledOff,
      solvers = Solvers("a build", _ => Right(Silent), toldAfter = Span.ofMillis(10))
    )
    val started = LiveFlights.start(assembler, flown.plans.takeRight(1), folder)
    for
      _ <- waits.future
      _ = assertEquals(names(folder).count(_.endsWith(".duckdb")), 1)
      _ = requests.stopAll("ended from outside")
      outcome <- started
    yield
      assertEquals(outcome.map(_.progress.size), Left(s"${flown.plans.last.id}: ended from outside"))
      assertEquals(names(folder), Vector.empty)

  folder.test("a flight abandoned while a silent simulator is awaited leaves no recording"): folder =>
    val silent    = ServerSocket(0, 50, InetAddress.getLoopbackAddress)
    val abandoned = Promise[String]()
    val flown     = settings(None)
    val at        = Address("127.0.0.1", silent.getLocalPort)
    val assembler = FlightAssembler(TcpTransport(), Clock.system, flown, Some(at))
    val started = LiveFlights.start(assembler, flown.plans.takeRight(1), folder, abandoned = abandoned.future)
    for
      _ <- Future(silent.accept())
      _ = assertEquals(names(folder).count(_.endsWith(".duckdb")), 1)
      _ = abandoned.success("ended from outside")
      outcome <- started
    yield
      silent.close()
      assertEquals(outcome.map(_.progress.size), Left(s"${flown.plans.last.id}: ended from outside"))
      assertEquals(names(folder), Vector.empty)
