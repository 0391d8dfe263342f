package skein.link

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.util.ByteString
import org.apache.pekko.{Done, NotUsed}
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.signal.*
import skein.testing.Unhurried
import skein.units.*

/** Real sockets on loopback and the real clock. */
class LinkProxyLiveSuite extends munit.FunSuite, Unhurried:
  private given system: ActorSystem = ActorSystem("link-proxy", PreciseScheduler.config)
  private given ExecutionContext    = system.dispatcher
  private val transport             = TcpTransport()
  private val anyPort               = Address("127.0.0.1", 0)

  override def afterAll(): Unit = system.terminate(): Unit

  private def serve(handler: Flow[ByteString, ByteString, Any]): Future[Listening] =
    transport.listen(anyPort).to(Sink.foreach(_.flow.join(handler).run(): Unit)).run()

  private def proxyTo(server: Listening, profile: LinkProfile): Future[LinkProxy] =
    LinkProxy.start(anyPort, server.address, EmulatedLink(profile, seed = 1, Clock.system), transport)

  private def constant(roundTrip: Span): LatencyProfile =
    LatencyProfile.Steady("constant", LatencyDistribution.Constant(roundTrip))

  private def repeat(message: ByteString, every: FiniteDuration): Source[ByteString, NotUsed] =
    Source.tick(every, every, message).mapMaterializedValue(_ => NotUsed)

  test("10 MB cross a slow link and return unchanged, and every byte is counted"):
    val random = SplitMix64(1)
    val sent   = Vector.fill(160)(ByteString(Array.fill(65536)(random.nextLong().toByte)))
    for
      server <- serve(Flow[ByteString])
      proxy  <- proxyTo(
        server,
        LinkProfile(LatencyProfile.direct, constant(Span.ofMillis(5)), maxBytesInFlight = 200_000)
      )
      back <- Source(sent).via(transport.connect(proxy.address)).runFold(ByteString.empty)(_ ++ _)
      _    <- proxy.close()
      _    <- server.close()
    yield
      assertEquals(back.size, 160 * 65536)
      assert(back == sent.reduce(_ ++ _))
      assertEquals(proxy.counts.connections, 1L)
      assertEquals(proxy.counts.bytesToServer, 160L * 65536)
      assertEquals(proxy.counts.bytesToClient, 160L * 65536)

  test("the end of sending crosses after the delay, in both directions"):
    for
      server <- serve(Flow[ByteString].fold(ByteString.empty)(_ ++ _))
      proxy  <- proxyTo(server, LinkProfile.symmetric(constant(Span.ofMillis(200))))
      began = Clock.system.now()
      back <- Source.single(
        ByteString("ab")
      ).via(transport.connect(proxy.address)).runFold(ByteString.empty)(_ ++ _)
      took = Clock.system.now().since(began)
      _ <- proxy.close()
      _ <- server.close()
    yield
      assertEquals(back, ByteString("ab"))
      assert(took >= Span.ofMillis(200), took.toMillis)

  test("without a server the client's connection breaks, and the proxy reports why"):
    val told = Promise[Throwable]()
    for
      server <- serve(Flow[ByteString])
      _      <- server.close()
      link = EmulatedLink(LinkProfile.symmetric(constant(Span.ofMillis(10))), seed = 1, Clock.system)
      proxy <-
        LinkProxy.start(anyPort, server.address, link, transport, unreachable = told.trySuccess(_): Unit)
      error <- Source.maybe[ByteString].via(transport.connect(proxy.address)).runWith(Sink.ignore).failed
      why   <- told.future
      _     <- proxy.close()
    yield
      assertEquals(why, TransportError.NobodyListens(server.address))
      error match
        case TransportError.Lost(to, _) => assertEquals(to, proxy.address)
        case other                      => fail(s"expected Lost, got $other")

  test("a reset breaks both sides of the connection, and the next one works"):
    val profile = LinkProfile.none.copy(faults = Faults(List(TimedFault(Span.ofMillis(300), Fault.Reset))))
    val ended   = Promise[Done]()
    val echo    = Flow[ByteString].watchTermination()((_, done) => ended.completeWith(done))
    for
      server <- serve(echo)
      proxy  <- proxyTo(server, profile)
      error  <-
        repeat(ByteString("x"), 10.millis).via(transport.connect(proxy.address)).runWith(Sink.ignore).failed
      _     <- ended.future.failed
      again <-
        Source.single(ByteString("y")).via(transport.connect(proxy.address)).runFold(ByteString.empty)(_ ++ _)
      _ <- proxy.close()
      _ <- server.close()
    yield
      assert(error.isInstanceOf[TransportError.Lost], error)
      assertEquals(again, ByteString("y"))
      assertEquals(proxy.counts.disconnects, 1L)

  test("a stall delays everything, and loses nothing"):
    val stall   = TimedFault(Span.ofMillis(200), Fault.Stall(Span.ofMillis(300)))
    val profile = LinkProfile.none.copy(faults = Faults(List(stall)))
    for
      server   <- serve(Flow[ByteString])
      proxy    <- proxyTo(server, profile)
      arrivals <- repeat(ByteString("x"), 10.millis)
        .take(60)
        .via(transport.connect(proxy.address))
        .map(bytes => (Clock.system.now(), bytes.size))
        .runWith(Sink.seq)
      _ <- proxy.close()
      _ <- server.close()
    yield
      val gaps = arrivals.map(_._1).sliding(2).collect { case Seq(a, b) => b.since(a) }.toList
      assertEquals(arrivals.map(_._2).sum, 60)
      assert(gaps.max >= Span.ofMillis(250), gaps.max.toMillis)
      assert(proxy.counts.stalls >= 1, proxy.counts)

  test("closing the proxy closes its connections"):
    for
      server <- serve(Flow[ByteString])
      proxy  <- proxyTo(server, LinkProfile.none)
      (connected, done) = Source
        .maybe[ByteString]
        .viaMat(transport.connect(proxy.address))(Keep.right)
        .toMat(Sink.ignore)(Keep.both)
        .run()
      _ <- connected
      _ <- exchange(proxy.address)
      _ <- proxy.close()
      _ <- done
      _ <- server.close()
    yield ()

  private def exchange(at: Address): Future[ByteString] =
    Source.single(ByteString("accepted in turn")).via(transport.connect(at)).runFold(ByteString.empty)(_ ++ _)
