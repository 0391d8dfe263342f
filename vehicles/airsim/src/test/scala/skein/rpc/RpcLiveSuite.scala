package skein.rpc

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.Future
import skein.link.{Address, TcpTransport}
import skein.units.*
import upack.{Binary, Float64, Int32, Msg}

/** Client and server over loopback sockets and the machine's clock. */
class RpcLiveSuite extends munit.FunSuite:
  private given system: ActorSystem = ActorSystem("rpc-live")
  import system.dispatcher

  override def afterAll(): Unit =
    val _ = system.terminate()

  private val transport = TcpTransport()

  private def handler(request: RpcRequest): Future[Either[String, Msg]] = request.method match
    case "add"   => Future.successful(Right(Float64(request.params.map(_.float64).sum)))
    case "echo"  => Future(Right(request.params.head))
    case "throw" => throw IllegalStateException("std::bad_cast")
    case other   => Future.successful(Left(s"rpclib: server could not find function '$other'"))

  private def withPair[A](use: (RpcServer, RpcClient) => Future[A]): Future[A] =
    for
      server <- RpcServer.bind(transport, Address("127.0.0.1", 0))(handler)
      client = RpcClient(transport, server.address, Clock.system)
      result <- use(server, client).transformWith(r => client.close().transform(_ => r))
      _      <- server.close()
    yield result

  test("a call gets its result, the peer's text if the function is unknown, or rpclib's if it throws"):
    withPair: (_, client) =>
      for
        sum     <- client.callAs[Double]("add", Seq(Float64(1.5), Float64(2)))
        unknown <- client.call("nosuch", Seq.empty)
        thrown  <- client.call("throw", Seq(Int32(1)))
      yield
        assertEquals(sum, Right(3.5))
        assertEquals(
          unknown,
          Left(RpcError.Refused("nosuch", "rpclib: server could not find function 'nosuch'"))
        )
        assertEquals(
          thrown,
          Left(
            RpcError.Refused(
              "throw",
              "rpclib: function 'throw' (called with 1 arg(s)) threw an exception. " +
                "The exception contained this information: std::bad_cast."
            )
          )
        )

  test("ten thousand pipelined calls each get their own answer, and a flow emits them in order"):
    withPair: (_, client) =>
      Source(1 to 10_000)
        .mapAsync(200)(i =>
          client.callStampedAs[Int]("echo", Seq(Int32(i)), CallOptions(whenFull = WhenFull.Wait))
        )
        .collect { case Right(answer) => answer.value }
        .runWith(Sink.seq)
        .map: answers =>
          assertEquals(answers, (1 to 10_000).toVector)
          assertEquals(client.stats.answered, 10_000L)

  test("eight megabytes return unchanged on the bulk channel"):
    val image = Array.tabulate(8 << 20)(i => (i * 31).toByte)
    withPair: (_, client) =>
      client
        .call("echo", Seq(Binary(image)), CallOptions(channel = Channel.Bulk))
        .map:
          case Right(Binary(back)) => assert(java.util.Arrays.equals(back, image))
          case other               => fail(s"$other")

  test("without a listener a call fails immediately with the address"):
    val client = RpcClient(transport, Address("127.0.0.1", 1), Clock.system)
    client.call("ping", Seq.empty).map {
      case Left(RpcError.Unreachable(address, _)) => assertEquals(address, Address("127.0.0.1", 1))
      case other                                  => fail(s"$other")
    }

  test("a connection beyond the limit is refused and counted, and all calls fail when the server closes"):
    val one = RpcSettings(controlConnections = 1)
    for
      server <- RpcServer.bind(transport, Address("127.0.0.1", 0), ServerLimits(connections = 1))(handler)
      first = RpcClient(transport, server.address, Clock.system, one)
      served <- first.call("echo", Seq(Int32(1)))
      second = RpcClient(transport, server.address, Clock.system, one)
      away  <- second.call("echo", Seq(Int32(2)))
      still <- first.call("echo", Seq(Int32(3)))
      stats = server.stats
      _     <- server.close()
      after <- first.call("echo", Seq(Int32(4)))
      _     <- first.close()
      _     <- second.close()
    yield
      assertEquals(served, Right(Int32(1)))
      assertEquals(still, Right(Int32(3)))
      assertEquals((stats.connections, stats.accepted), (1L, 1L))
      assert(stats.turnedAway >= 1, s"$stats")
      assert(isLost(away), s"$away")
      assert(isLost(after), s"$after")

  private def isLost(result: Either[RpcError, Msg]): Boolean = result match
    case Left(_: RpcError.ConnectionLost | _: RpcError.Unreachable) => true
    case _                                                          => false
