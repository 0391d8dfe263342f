package skein.link

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future}
import skein.signal.LatencyProfile
import skein.units.*
import skein.vtime.VirtualTime

/** In virtual time, over hosts in memory. */
class LinkProxySuite extends munit.FunSuite:
  private val (proxyAt, serverAt) = (Address("proxy", 1), Address("server", 1))

  /** A client that records which of its bytes returned, and when its connection ended, s. */
  private final class Client(says: Source[ByteString, Any], world: World)(using ActorSystem):
    private var came                             = 0
    private var ended                            = Option.empty[Double]
    def seen: (came: Int, ended: Option[Double]) = (came = came, ended = ended)
    says
      .via(world.network.host("client").connect(proxyAt))
      .toMat(Sink.foreach(bytes => came += bytes.size))(Keep.right)
      .run()
      .onComplete(_ => ended = Some(world.seconds()))(using ExecutionContext.parasitic)

  private final class World(val network: MemoryNetwork, val seconds: () => Double)(using
      system: ActorSystem
  ):
    def until(at: Double): Future[Unit] =
      after((at - seconds()).seconds, system.scheduler)(Future.unit)(using system.dispatcher)

  /** A proxy with a single place, before a server that echoes. */
  private def through[A](body: ActorSystem ?=> (World, () => LinkCounts) => Future[A]): A =
    VirtualTime
      .run(1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = VirtualClock(system)
        val start              = clock.now()
        val network            = MemoryNetwork(NetworkPlan(), 1, clock)
        val world              = World(network, () => clock.now().since(start).toSeconds)
        val link               = EmulatedLink(LinkProfile.none, 1, clock)
        for
          _ <- network.host("server").listen(serverAt).to(
            Sink.foreach(_.flow.join(Flow[ByteString]).run(): Unit)
          ).run()
          proxy <- LinkProxy.start(proxyAt, serverAt, link, network.host("proxy"), maxConnections = 1)
          found <- body(world, () => proxy.counts)
          _     <- proxy.close()
        yield found
      .value

  private val silent                = Source.maybe[ByteString]
  private val once                  = Source.single(ByteString("x")).concat(Source.maybe)
  private def always(until: Double) =
    Source.tick(1.milli, 1.second, ByteString("x")).takeWithin(until.seconds)

  test("a connection without any data makes room for the next, also in its first second"):
    val (first, second) = through: (world, _) =>
      given ExecutionContext = ExecutionContext.parasitic
      val first              = Client(silent, world)
      for
        _ <- world.until(0.5)
        second = Client(once, world)
        _ <- world.until(1)
      yield (first.seen, second.seen)
    assertEquals(first.ended.map(_ < 0.6), Some(true))
    assertEquals(second, (came = 1, ended = None))

  test("a connection with data keeps its place for 5 s, and each further byte prolongs that"):
    for (says, lasts) <- Seq((once, 5.0), (always(until = 9.5), 14.0)) do
      val (first, second, third, counts) = through: (world, counts) =>
        given ExecutionContext = ExecutionContext.parasitic
        val first              = Client(says.concat(Source.maybe), world)
        for
          _ <- world.until(lasts - 0.1)
          second = Client(once, world)
          _ <- world.until(lasts + 0.1)
          third = Client(once, world)
          _ <- world.until(lasts + 1)
        yield (first.seen, second.seen, third.seen, counts())
      assertEquals((second.came, second.ended.map(_ < lasts)), (0, Some(true)))
      assertEquals(first.ended.map(at => at > lasts && at < lasts + 0.2), Some(true))
      assertEquals(third, (came = 1, ended = None))
      assertEquals((counts.connections, counts.disconnects), (2L, 0L))

  test("closing waits until the last bytes of all connections have arrived, or for a limited time"):
    val profile = LatencyProfile.parse("constant:400ms", Left(_)).toOption.get
    val waited  = VirtualTime
      .run(1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = VirtualClock(system)
        val start              = clock.now()
        val network            = MemoryNetwork(NetworkPlan(), 1, clock)
        val world              = World(network, () => clock.now().since(start).toSeconds)
        var came               = 0
        val heard              = Flow[ByteString].map: bytes =>
          came += bytes.size
          bytes
        for
          _ <- network.host("server").listen(serverAt).to(Sink.foreach(_.flow.join(heard).run(): Unit)).run()
          link = EmulatedLink(LinkProfile.symmetric(profile), 1, clock)
          proxy <- LinkProxy.start(proxyAt, serverAt, link, network.host("proxy"))
          _ = Client(Source.single(ByteString("x")), world)
          _ <- world.until(0.1)
          before = came
          _ <- proxy.ended(Span.ofSeconds(2))
          after = (came, world.seconds() < 1)
          _     = Client(once, world)
          _ <- world.until(5)
          _ <- proxy.ended(Span.ofSeconds(2))
          late = world.seconds()
          _ <- proxy.close()
        yield (before, after, late)
      .value
    assertEquals(waited, (0, (1, true), 7.0))

  test("a connection that has ended frees its place"):
    val came = through: (world, _) =>
      given ExecutionContext = ExecutionContext.parasitic
      (0 until 4).foldLeft(Future.successful(0)): (before, number) =>
        for
          came <- before
          client = Client(Source.single(ByteString("x")), world)
          _ <- world.until(number + 0.5)
        yield came + client.seen.came
    assertEquals(came, 4)
