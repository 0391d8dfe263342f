package skein.simulator

import java.io.IOException
import java.net.{DatagramPacket, DatagramSocket, InetAddress, Socket, SocketTimeoutException}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.hil.{AutopilotKind, SmallAutopilot}
import skein.link.{Address, PreciseScheduler, TcpTransport}
import skein.mavlink.{FrameWriter, Heartbeat}
import skein.rpc.{CallOptions, MessageWriter, RpcClient, RpcSettings}
import skein.testing.{Unhurried, Waiting}
import skein.units.*
import upack.*
import upickle.default.writeMsg
import skein.airsim.wire.YawMode

/** Attacks by strangers on the simulator's ports, over real sockets. */
class AttackedLiveSuite extends munit.FunSuite, Waiting, Unhurried:
  private given system: ActorSystem = ActorSystem("attacked", PreciseScheduler.config)

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 120.seconds)

  private val loopback = InetAddress.getLoopbackAddress
  private val free     = Address("127.0.0.1", 0)

  private def serving[A](settings: SimulatorSettings = SimulatorSettings(address = free))(
      use: SimulatorServer => A
  ): A =
    val server = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 120.seconds)
    try use(server)
    finally
      val _ = Await.result(server.close(), 120.seconds)

  private def asked[A](server: SimulatorServer)(use: ((String, Seq[Msg]) => Msg) => A): A =
    val client = RpcClient(TcpTransport(), server.address, Clock.system, RpcSettings(controlConnections = 1))
    try
      use: (method, params) =>
        Await.result(
          client.call(method, params, CallOptions(timeout = Span.ofSeconds(100))),
          120.seconds
        ).fold(error => fail(s"$method: $error"), identity)
    finally
      val _ = Await.result(client.close(), 120.seconds)

  private def until(what: String)(holds: => Boolean): Unit =
    val patience = System.nanoTime() + 120_000_000_000L
    while !holds do
      assert(System.nanoTime() < patience, s"it never came to hold: $what")
      Thread.`yield`()

  private def connected(at: Address): Socket =
    val socket = Socket(loopback, at.port)
    socket.setSoTimeout(120_000)
    socket

  /** Whether the peer closes the connection without sending anything. */
  private def isClosed(socket: Socket): Boolean =
    try socket.getInputStream.read() < 0
    catch
      case _: SocketTimeoutException => false
      case _: IOException            => true

  private def request(calls: (String, Seq[Msg])*): Array[Byte] =
    val writer = new MessageWriter
    for ((method, params), id) <- calls.zipWithIndex do writer.request(id, method, params)
    writer.take().toArray

  /** A browser's requests for a page, followed by the page's own bytes. */
  private def posts(body: Array[Byte]): Seq[Array[Byte]] =
    val methods = Seq("POST", "PUT", "GET", "OPTIONS", "HEAD", "DELETE", "PATCH")
    methods.map: method =>
      s"$method / HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: https://elsewhere.example\r\n\r\n".getBytes ++ body

  private val hello = Array[Byte](22, 3, 1, 2, 0, 1, 0, 1)

  test("a page's connections to the RPC port are closed, and no request in them is obeyed"):
    serving(): server =>
      val body = request("simPause" -> Seq(Bool(true)), "enableApiControl" -> Seq(Bool(true), Str("")))
      for sent <- posts(body) :+ (hello ++ body) :+ (Array[Byte](5) ++ body) do
        val page = connected(server.address)
        page.getOutputStream.write(sent)
        assert(isClosed(page), String(sent.take(8)))
      assertEquals(server.stats.requests, 0L)
      asked(server)(call => assertEquals(call("simIsPaused", Nil), Bool(false)))

  test("a page that connects to an autopilot's port neither stops the motors nor receives anything"):
    val hil    = HilSettings(AutopilotKind.Px4, Vector(free))
    val flying = SmallAutopilot()
    serving(SimulatorSettings(address = free, hil = Some(hil))): server =>
      asked(server): call =>
        call("enableApiControl", Seq(Bool(true), Str(""))): Unit
        call("armDisarm", Seq(Bool(true), Str(""))): Unit
        val pose = skein.airsim.wire.Pose(
          skein.airsim.wire.Vector3r(0, 0, -20),
          skein.airsim.wire.Quaternionr(1, 0, 0, 0)
        )
        call("skeinHoverAt", Seq(writeMsg(pose), Str(""))): Unit
        val at     = server.peerAddresses.head
        val silent = connected(at)
        for sent <- posts(flying.greeting) :+ (hello ++ flying.greeting) do
          val page = connected(at)
          page.getOutputStream.write(sent)
          assert(isClosed(page))
        until("simulated time has passed")(up(server) > 1)
        assertEqualsDouble(down(server), -20, 0.1)
        // A peer that only connects makes room for the autopilot.
        val autopilot = connected(at)
        autopilot.getOutputStream.write(flying.greeting)
        assert(autopilot.getInputStream.read() >= 0)
        assert(isClosed(silent))
        autopilot.close()
      // A page that connects before the last one has made room is refused.
      val stats = server.peerStats
      assert(stats.foreign >= 1L && stats.foreign + stats.turnedAway >= 8L, s"$stats")

  private def up(server: SimulatorServer) =
    val now = Await.result(server.truth(), 120.seconds).at
    started.getOrElseUpdate(server, now)
    now.since(started(server)).toSeconds
  private val started = scala.collection.mutable.Map.empty[SimulatorServer, Instant]

  private def down(server: SimulatorServer) =
    Await.result(server.truth(), 120.seconds).vehicles.head.kinematics.positionNed.z

  test("a costly expression of 328 bytes is answered, and so are all other clients"):
    serving(): server =>
      asked(server): call =>
        assertEquals(call("simListSceneObjects", Seq(Str("(.*)*" * 60 + "x"))), Arr())
        assertEquals(call("ping", Nil), Bool(true))

  test("silent connections that fill a port make room for an active one"):
    val limits = SimulatorSettings.Limits.copy(connections = 4)
    serving(SimulatorSettings(address = free, limits = limits)): server =>
      val silent   = Seq.fill(4)(connected(server.address))
      val dripping = connected(server.address)
      dripping.getOutputStream.write(Array[Byte](0x94.toByte, 0))
      until("all places are taken")(server.stats.accepted == 5 && server.stats.connections == 4)
      for _ <- 1 to 3 do asked(server)(call => assertEquals(call("ping", Nil), Bool(true)))
      (silent :+ dripping).foreach(_.close())

  for isPaused <- Seq(true, false) do
    test(s"twelve long moves of a client that has left delay no other client${
        if isPaused then ", in paused time" else ""
      }"):
      serving(): server =>
        val leaving = connected(server.address)
        val move    =
          Seq(Float32(1), Float32(0), Float32(-5), Float32(1000), Int32(0), writeMsg(YawMode.Still), Str(""))
        val calls = Seq(
          "enableApiControl" -> Seq(Bool(true), Str("")),
          "armDisarm"        -> Seq(Bool(true), Str("")),
          "simPause"         -> Seq(Bool(isPaused))
        ) ++ Seq.fill(12)("moveByVelocityZ" -> move)
        leaving.getOutputStream.write(request(calls*))
        until("the moves have come")(server.stats.requests == 15)
        leaving.close()
        asked(server): call =>
          call("getMultirotorState", Seq(Str(""))): Unit
          call("simPause", Seq(Bool(false))): Unit
          assertEquals(call("simIsPaused", Nil), Bool(false))

  test("while moves hold all workers a ping of their own connection is still answered"):
    serving(): server =>
      val one  = connected(server.address)
      val move =
        Seq(Float32(1), Float32(0), Float32(-5), Float32(1000), Int32(0), writeMsg(YawMode.Still), Str(""))
      val calls = Seq.fill(12)("moveByVelocityZ" -> move) :+ ("ping" -> Nil)
      one.getOutputStream.write(request(calls*))
      // Its answer holds its number, 12; of the moves only the replaced first one is answered.
      val seen = scala.collection.mutable.ArrayBuffer.empty[Int]
      until("the ping is answered"):
        seen += one.getInputStream.read()
        seen.containsSlice(Seq(0x94, 1, 12))
      one.close()

  test("UDP peers without a MAVLink message are not admitted, and silent ones make room"):
    val port    = MavlinkPort(free)
    val mavlink = MavlinkSettings(udp = Vector(port))
    serving(SimulatorSettings(address = free, mavlink = Some(mavlink))): server =>
      val at                                            = server.peerAddresses.head
      def say(from: DatagramSocket, bytes: Array[Byte]) =
        from.send(DatagramPacket(bytes, bytes.length, loopback, at.port))
      val beat   = FrameWriter(245, 190).write(Heartbeat(6, 8, 0, 0, 4, 3))
      val noise  = Seq.fill(100)(DatagramSocket(0, loopback))
      val voices = Seq.fill(64)(DatagramSocket(0, loopback))
      for socket <- noise do say(socket, Array[Byte](1, 2, 3))
      for socket <- voices do say(socket, beat)
      val honest = DatagramSocket(0, loopback)
      honest.setSoTimeout(200)
      val packet = DatagramPacket(new Array[Byte](2000), 2000)
      def isTold =
        try
          say(honest, beat)
          honest.receive(packet)
          true
        catch case _: SocketTimeoutException => false
      until("a peer that speaks is told of the vehicle")(isTold)
      (noise ++ voices :+ honest).foreach(_.close())
