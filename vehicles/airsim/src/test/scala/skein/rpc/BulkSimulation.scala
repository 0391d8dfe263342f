package skein.rpc

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future}
import skein.link.*
import skein.signal.{Bandwidth, LatencyDistribution, LatencyProfile}
import skein.units.*
import skein.vtime.VirtualTime
import upack.{Binary, Int32}

/** Images concurrent with control over a line of 50 Mbit/s, in virtual time. */
class BulkSimulation extends munit.FunSuite:
  private given ExecutionContext = ExecutionContext.parasitic
  private val address            = Address("simulator", 41451)
  private val image              = new Array[Byte](1280 * 720 * 3)

  private enum Images:
    case None, OwnLane, ControlLane

  /** Round trips of a small request each 20 ms for 10 s, ascending, ms; and the number of images received
    * meanwhile.
    */
  private def fly(images: Images): (Vector[Double], Int) =
    VirtualTime
      .run(1): system =>
        given ActorSystem = system
        val clock         = VirtualClock(system)
        val twenty        = LatencyProfile.Steady("", LatencyDistribution.Constant(Span.ofMillis(20)))
        val line          = LatencyProfile.Limited("", twenty, Bandwidth.ofBitsPerSecond(50_000_000))
        val network       = MemoryNetwork(NetworkPlan(LinkProfile.symmetric(line)), 1, clock)
        val client        =
          RpcClient(network.host("controller"), address, clock, RpcSettings(controlConnections = 1))
        def bytes(): Future[Int] = images match
          case Images.OwnLane =>
            client.callBulk("image", Seq())(_.binary().length).map(_.fold(e => fail(e.message), _.value))
          case _ => client.callAs[Array[Byte]]("image", Seq()).map(_.fold(e => fail(e.message), _.length))
        for
          server <- RpcServer.bind(network.host("simulator"), address): request =>
            Future.successful(Right(if request.method == "image" then Binary(image) else Int32(1)))
          taken = Source
            .tick(100.millis, 500.millis, ())
            .take(if images == Images.None then 0 else 18)
            .mapAsync(2)(_ => bytes())
            .runWith(Sink.seq)
          trips <- Source
            .tick(0.millis, 20.millis, ())
            .take(500)
            .mapAsync(64)(_ =>
              client.callStamped("state", Seq()).map(_.fold(e => fail(e.message), _.roundTrip))
            )
            .runWith(Sink.seq)
          came <- taken
          _    <- client.close()
          _    <- server.close()
        yield
          assert(came.forall(_ == image.length), came)
          (trips.map(_.toMillis).toVector.drop(5).sorted, came.size)
      .value

  private def p99(sorted: Vector[Double]): Double = sorted((0.99 * sorted.size).toInt)

  test(
    "over 50 Mbit/s, images delay control by less than 6 ms on their own connection; by far more on control's"
  ):
    val (alone, _)     = fly(Images.None)
    val (beside, came) = fly(Images.OwnLane)
    val (behind, _)    = fly(Images.ControlLane)
    assertEquals(came, 18)
    assertEqualsDouble(p99(alone), 20, 0.1)
    assert(p99(beside) < 26, p99(beside))
    assert(p99(behind) > 300, p99(behind))

  test("a result of another type than requested is reported, and the connection survives"):
    val answers = VirtualTime
      .run(1): system =>
        given ActorSystem = system
        val network       = MemoryNetwork(NetworkPlan(), 1, VirtualClock(system))
        val client        = RpcClient(network.host("controller"), address, VirtualClock(system))
        for
          server <- RpcServer.bind(network.host("simulator"), address)(request =>
            Future.successful(if request.method == "no" then Left("cannot") else Right(Int32(7)))
          )
          wrong   <- client.callBulk("seven", Seq())(_.string())
          refused <- client.callBulk("no", Seq())(_.string())
          right   <- client.callBulk("seven", Seq())(_.int())
          tree    <- client.call("seven", Seq(), CallOptions(channel = Channel.Bulk))
          stats = client.stats
          _ <- client.close()
          _ <- server.close()
        yield (wrong, refused, right.map(_.value), tree, stats.disconnected)
      .value
    assertEquals(
      answers,
      (
        Left(RpcError.Malformed("seven", "expected binary or a string, got a value that begins with 0x07")),
        Left(RpcError.Refused("no", "cannot")),
        Right(7),
        Right(Int32(7)),
        0L
      )
    )
