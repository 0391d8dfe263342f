package skein.link

import java.net.{InetAddress, ServerSocket}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.StreamTcpException
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.testing.Unhurried
import skein.units.Span

/** Real sockets on loopback. */
class TcpTransportLiveSuite extends munit.FunSuite, Unhurried:
  private given system: ActorSystem = ActorSystem("tcp-transport")
  private given ExecutionContext    = system.dispatcher
  private val transport             = TcpTransport()

  override def afterAll(): Unit = system.terminate(): Unit

  private def serve(handler: Flow[ByteString, ByteString, Any]): Future[Listening] =
    transport.listen(Address("127.0.0.1", 0)).to(Sink.foreach(_.flow.join(handler).run(): Unit)).run()

  private def exchange(to: Address, bytes: ByteString): Future[ByteString] =
    Source.single(bytes).via(transport.connect(to)).runFold(ByteString.empty)(_ ++ _)

  private def failureOf(future: Future[?]): Future[Throwable] = future.failed

  test("bytes come back from an echo server, and a finished sender still receives the rest"):
    val everythingReversed = Flow[ByteString].fold(ByteString.empty)(_ ++ _).map(_.reverse)
    for
      server <- serve(everythingReversed)
      answer <- exchange(server.address, ByteString("geese"))
      _      <- server.close()
    yield assertEquals(answer.utf8String, "eseeg")

  test("the server's end of sending completes the client's input while the client may still send"):
    val received = Promise[ByteString]()
    val greets   = Flow.fromSinkAndSource(
      Sink.fold[ByteString, ByteString](ByteString.empty)(_ ++ _).mapMaterializedValue(received.completeWith),
      Source.single(ByteString("hello"))
    )
    for
      server <- serve(greets)
      toSend = Promise[ByteString]()
      heard <- Source
        .future(toSend.future)
        .viaMat(transport.connect(server.address))(Keep.right)
        .runFold(ByteString.empty)(_ ++ _)
      _ = toSend.success(ByteString("after your end"))
      got <- received.future
      _   <- server.close()
    yield
      assertEquals(heard.utf8String, "hello")
      assertEquals(got.utf8String, "after your end")

  test("without a listener, the future and the stream fail with an error that states that and the address"):
    val socket = ServerSocket(0, 1, InetAddress.getLoopbackAddress)
    val free   = Address("127.0.0.1", socket.getLocalPort)
    socket.close()
    val (connected, stream) =
      Source.maybe[ByteString].viaMat(transport.connect(free))(Keep.right).toMat(Sink.ignore)(Keep.both).run()
    for
      first  <- failureOf(connected)
      second <- failureOf(stream)
    yield
      assertEquals(first, TransportError.NobodyListens(free))
      assertEquals(second, TransportError.NobodyListens(free))
      assertEquals(first.getMessage, s"nobody listens at $free; is the program there started?")

  test("a host that never answers fails after the connect timeout"):
    // A full backlog drops further requests, as a firewall does.
    val deaf    = ServerSocket(0, 1, InetAddress.getLoopbackAddress)
    val at      = Address("127.0.0.1", deaf.getLocalPort)
    val fillers = List.fill(8)(java.nio.channels.SocketChannel.open())
    fillers.foreach: channel =>
      channel.configureBlocking(false)
      channel.connect(deaf.getLocalSocketAddress): Unit
    val hurried = TcpTransport(connectTimeout = Span.ofMillis(300))
    failureOf(Source.maybe[ByteString].viaMat(hurried.connect(at))(Keep.right).to(Sink.ignore).run())
      .map(assertEquals(_, TransportError.NoAnswer(at, Span.ofMillis(300))))
      .andThen: _ =>
        fillers.foreach(_.close())
        deaf.close()

  test("an unknown host is reported as such"):
    val nowhere = Address("no-such-host.invalid", 41451)
    failureOf(Source.maybe[ByteString].viaMat(transport.connect(nowhere))(Keep.right).to(Sink.ignore).run())
      .map(assertEquals(_, TransportError.UnknownHost(nowhere)))

  test("a port in use is reported as such"):
    for
      server <- serve(Flow[ByteString])
      error  <- failureOf(transport.listen(server.address).to(Sink.ignore).run())
      _      <- server.close()
    yield assertEquals(error, TransportError.PortTaken(server.address))

  test("listening at another machine's address fails"):
    val foreign = Address("192.0.2.1", 0)
    failureOf(transport.listen(foreign).to(Sink.ignore).run()).map:
      case TransportError.CannotListen(`foreign`, _) => ()
      case other                                     => fail(s"expected CannotListen, got $other")

  test("a connection that the peer resets fails with its address"):
    val resetting =
      Flow.fromSinkAndSourceCoupled(Sink.ignore, Source.failed[ByteString](RuntimeException("crash")))
    for
      server <- serve(resetting)
      error <- failureOf(Source.maybe[ByteString].via(transport.connect(server.address)).runWith(Sink.ignore))
      _     <- server.close()
    yield error match
      case TransportError.Lost(to, _) => assertEquals(to, server.address)
      case other                      => fail(s"expected Lost, got $other")

  test("a connection that is reset before this side has seen it open is lost, too"):
    val to    = Address("127.0.0.1", 41451)
    val reset = StreamTcpException("").initCause(java.io.IOException("Connection reset by peer"))
    assertEquals(
      TcpTransport.connectError(to, Span.ofSeconds(1))(reset),
      TransportError.Lost(to, "Connection reset by peer")
    )

  test("after close a listener accepts no more, and open connections stay open"):
    for
      server <- serve(Flow[ByteString])
      toSend              = Promise[ByteString]()
      (connected, answer) = Source
        .future(toSend.future)
        .viaMat(transport.connect(server.address))(Keep.right)
        .toMat(Sink.fold(ByteString.empty)(_ ++ _))(Keep.both)
        .run()
      _     <- connected
      _     <- exchange(server.address, ByteString("accepted in turn, so the first is accepted too"))
      _     <- server.close()
      error <- failureOf(exchange(server.address, ByteString("late")))
      _ = toSend.success(ByteString("still here"))
      got <- answer
    yield
      assertEquals(error, TransportError.NobodyListens(server.address))
      assertEquals(got.utf8String, "still here")
