package skein.simulator

import java.net.{InetAddress, Socket}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.airsim.wire.YawMode
import skein.link.{Address, TcpTransport}
import skein.rpc.{MessageWriter, RpcClient, RpcError, RpcSettings}
import skein.testing.Unhurried
import skein.units.*
import upack.{Bool, Float32, Int32, Msg, Str}
import upickle.default.writeMsg

/** Calls whose connection has closed, and the port when the simulation fails; over real sockets. */
class SimulatorServerLiveSuite extends munit.FunSuite, Unhurried:
  private given system: ActorSystem = ActorSystem("simulator-server")

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  private val settings = SimulatorSettings(address = Address("127.0.0.1", 0))

  private def start(settings: SimulatorSettings, clock: Clock = Clock.system): SimulatorServer =
    Await.result(SimulatorServer.start(settings, TcpTransport(), clock), 10.seconds)

  private def client(server: SimulatorServer): RpcClient =
    RpcClient(TcpTransport(), server.address, Clock.system, RpcSettings(controlConnections = 1))

  private def until(what: String)(holds: => Boolean): Unit =
    val patience = System.nanoTime() + 10_000_000_000L
    while !holds do
      assert(System.nanoTime() < patience, s"it never came to hold: $what")
      Thread.`yield`()

  test(
    "the waiting calls of a closed connection are counted but not run; calls of other connections are run"
  ):
    val server                             = start(settings.copy(overload = Overload.Workers(1)))
    val honest                             = client(server)
    def call(method: String, params: Msg*) = honest.call(method, params)
    Await.result(call("enableApiControl", Bool(true), Str("")), 10.seconds)
    // A move holds the only worker.
    val move = Seq(Float32(0), Float32(0), Float32(0), Float32(1), Int32(0), writeMsg(YawMode.Still), Str(""))
    val flown = call("moveByVelocity", move*)
    until("the move is under way")(server.stats.requests == 2)
    val socket = Socket(InetAddress.getLoopbackAddress, server.address.port)
    val writer = new MessageWriter
    for id <- 0 until 100 do writer.request(id, "enableApiControl", Seq(Bool(false), Str("")))
    socket.getOutputStream.write(writer.take().toArrayUnsafe())
    until("the calls wait")(server.stats.requests == 102)
    socket.setSoLinger(true, 0) // closes with a reset
    socket.close()
    until("the calls are dropped")(server.stats.dropped == 100)
    val after = call("isApiControlEnabled", Str(""))
    assert(Await.result(flown, 10.seconds).isRight)
    assertEquals(Await.result(after, 10.seconds), Right(Bool(true)))
    Await.result(honest.close(), 10.seconds)
    Await.result(server.close(), 10.seconds): Unit

  test("a failing simulation closes its connections and its port, and reports the reason"):
    @volatile var broken = false
    val clock: Clock     =
      () => if broken then throw IllegalStateException("no more time") else Clock.system.now()
    val server = start(settings, clock)
    val caller = client(server)
    assertEquals(Await.result(caller.call("ping", Seq.empty), 10.seconds), Right(Bool(true)))
    assertEquals(server.failed.value, None)
    broken = true
    Await.result(caller.call("ping", Seq.empty), 10.seconds) match
      case Left(_: RpcError.ConnectionLost) => ()
      case other                            => fail(s"$other")
    assertEquals(Await.result(server.failed, 10.seconds).getMessage, "no more time")
    Await.result(caller.close(), 10.seconds)
    val again = client(server)
    Await.result(again.call("ping", Seq.empty), 10.seconds) match
      case Left(RpcError.Unreachable(_, reason)) => assert(reason.contains("nobody listens"), reason)
      case other                                 => fail(s"$other")
    Await.result(again.close(), 10.seconds): Unit
