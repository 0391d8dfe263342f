package skein.simulator

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.Flow
import org.apache.pekko.util.ByteString
import scala.concurrent.Future
import skein.policy.Action
import skein.airsim.*
import skein.link.*
import skein.port.VehicleError
import skein.rpc.{Framed, Framer, RpcMessage, RpcClient}
import skein.units.*
import skein.vtime.VirtualTime

/** Answers to moves that are lost on a live connection. */
class AirSimVehicleSuite extends munit.FunSuite:
  private val address = Address("simulator", 41451)

  /** The simulator's transport without the messages for which `isLost` is true. Each message is a segment
    * here.
    */
  private final class Lossy(transport: Transport, isLost: RpcMessage => Boolean) extends Transport:
    def connect(to: Address) = transport.connect(to)
    def listen(at: Address)  =
      transport.listen(at).map(incoming => incoming.copy(flow = losing.via(incoming.flow)))

    private def losing = Flow[ByteString]
      .statefulMap(() => new Framer())(
        (framer, bytes) =>
          framer.offer(bytes)
          val frames = Vector.unfold(framer): framer =>
            framer.next() match
              case Framed.Complete(frame) => Some((frame, framer))
              case _                      => None
          (framer, frames)
        ,
        _ => None
      )
      .mapConcat(identity)
      .filterNot(frame => isLost(RpcMessage.fromServer(frame)))
      .map(ByteString.fromArrayUnsafe)

  /** Sends two moves 100 ms apart over a link with 40 ms round trips. Returns when the first ended, in ms
    * after the second was sent, with its result, and the reports on lost answers.
    */
  private def firstOfTwo(isLost: RpcMessage => Boolean)
      : (Long, Either[VehicleError, Boolean], Vector[String]) =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock = Clock.ofNanos(VirtualTime.clock(system))
        val link  =
          LinkProfile.symmetric(skein.signal.LatencyProfile.parse("constant:40ms", Left(_)).toOption.get)
        val network  = MemoryNetwork(NetworkPlan(links = Map(("controller", "simulator") -> link)), 1, clock)
        val settings = SimulatorSettings(address = address)
        var noted    = Vector.empty[String]
        var lossy    = false
        val client   = AirSimClient(RpcClient(network.host("controller"), address, clock), Span.ofMillis(500))
        for
          server <- SimulatorServer.start(
            settings,
            Lossy(network.host("simulator"), message => lossy && isLost(message)),
            clock
          )
          multirotor <-
            Multirotor.named(
              client,
              settings.world.vehicles.head.name
            ).map(_.fold(e => fail(e.message), identity))
          _ <- multirotor.enableApiControl()
          _ <- multirotor.arm()
          port  = AirSimVehicle(multirotor, noted :+= _)
          _     = lossy = true
          first = port.act(Action.VelocityAt(5, 0, Metres(-20)), Span.ofSeconds(10))
          _ <- after(Span.ofMillis(100).toDuration)(Future.unit)
          sentAt = clock.now()
          _      = port.act(Action.VelocityAt(0, 5, Metres(-20)), Span.ofSeconds(10))
          result <- first
          endedAt = clock.now()
          _ <- client.close()
          _ <- server.close()
        yield (endedAt.since(sentAt).toNanos / 1_000_000, result, noted)
      .value

  private def isMovesAnswer(message: RpcMessage): Boolean = message match
    case RpcMessage.Reply(_, _, upack.False) => true
    case _                                   => false

  test("a replaced move ends a round trip later, and no answer counts as lost"):
    assertEquals(firstOfTwo(_ => false), (40L, Right(false), Vector.empty))

  test(
    "a lost answer counts as replaced once the next move is received and a further cancel has ended nothing"
  ):
    val (afterMs, result, noted) = firstOfTwo(isMovesAnswer)
    assertEquals((afterMs, result, noted.size), (780L, Right(false), 1))

  test("a vehicle whose probes are lost is waited for as long as the move lasts"):
    val (afterMs, result, noted) = firstOfTwo(_ => true)
    assert(afterMs > 10_000, s"$afterMs ms")
    assert(result.left.exists { case VehicleError.TimedOut(_) => true; case _ => false }, result.toString)
    assertEquals(noted, Vector.empty)
