package skein.flight

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.link.*
import skein.loop.LoopKind
import skein.record.MemoryRecorder
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.*
import skein.vtime.VirtualTime

class FlightAssemblerSuite extends munit.FunSuite:

  /** Listens `allowed` times at most; counts the open listeners. */
  private final class Ports(transport: Transport, allowed: Int)(using system: ActorSystem) extends Transport:
    import system.dispatcher
    var asked, open = 0

    def connect(to: Address) = transport.connect(to)

    def listen(at: Address) =
      asked += 1
      if asked > allowed then
        org.apache.pekko.stream.scaladsl.Source.failed(TransportError.PortTaken(at)).mapMaterializedValue(_ =>
          Future.failed(TransportError.PortTaken(at))
        )
      else
        transport
          .listen(at)
          .mapMaterializedValue(_.map: listening =>
            open += 1
            new Listening:
              def address: Address      = listening.address
              def close(): Future[Done] =
                open -= 1
                listening.close())

  private val settings = FlySettings(
    List(LoopKind.Stream),
    List(LatencyProfile.direct),
    duration = Span.ofSeconds(1),
    period = Span.ofMillis(100),
    seed = 1
  )

  /** The result of starting a flight, and the number of listeners left at the end. */
  private def start(allowed: Int): (Either[String, Unit], Int) =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock     = Clock.ofNanos(VirtualTime.clock(system))
        val ports     = Ports(MemoryNetwork(NetworkPlan(), 1, clock).host("localhost"), allowed)
        val assembler = FlightAssembler(ports, clock, settings, simulator = None)
        val plan      = settings.plans.head
        assembler
          .start(plan, MemoryRecorder(assembler.heading(plan, "virtual")))
          .flatMap:
            case Left(reason)    => Future.successful((Left(reason), ports.open))
            case Right(assembly) => assembly.landed.map(_ => (Right(()), ports.open))
      .value

  test("a flight that finds no port for its link closes its simulator"):
    val (result, open) = start(allowed = 1)
    assert(result.left.exists(_.contains("taken")), result.toString)
    assertEquals(open, 0)

  test("a flight that has landed has closed its simulator and its link"):
    assertEquals(start(allowed = 2), (Right(()), 0))
