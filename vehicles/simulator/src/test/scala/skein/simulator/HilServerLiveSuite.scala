package skein.simulator

import java.net.{DatagramPacket, DatagramSocket, InetAddress, Socket}
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.util.{Random, Success}
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.hil.*
import skein.link.{Address, PreciseScheduler, TcpTransport}
import skein.signal.Kinematics
import skein.testing.{Conclusive, Waiting}
import skein.units.*

/** Autopilots' interfaces over real sockets. */
class HilServerLiveSuite extends munit.FunSuite, Conclusive, Waiting:
  private given system: ActorSystem = ActorSystem("hil", PreciseScheduler.config)

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  private def serving[A](
      autopilot: AutopilotKind,
      speed: Double = 1,
      stateTo: Address = Address("127.0.0.1", 9)
  )(use: SimulatorServer => A): A =
    val settings = SimulatorSettings(
      WorldSettings(Vector(VehicleSettings("one"))),
      Address("127.0.0.1", 0),
      speed = speed,
      hil = Some(HilSettings(autopilot, Vector(Address("127.0.0.1", 0)), stateTo))
    )
    val server = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
    try use(server)
    finally
      val _ = Await.result(server.close(), 10.seconds)

  private def truth(server: SimulatorServer) =
    Await.result(server.truth(), 5.seconds).vehicles.head.kinematics

  test("a small autopilot flies over TCP; a second one is refused meanwhile"):
    conclusive:
      serving(AutopilotKind.Px4, speed = 4): server =>
        val at        = server.peerAddresses.head
        val autopilot = SmallAutopilot()
        val flown     = HilPeer.fly(autopilot, 20_000_000, at, TcpTransport())()
        while autopilot.heard.isEmpty do Thread.onSpinWait()
        val other = Socket(at.host, at.port)
        other.setSoTimeout(5000)
        assertEquals(other.getInputStream.read(), -1)
        other.close()
        // Not its final position: without control the vehicle sinks, and this thread may learn that late.
        var seen  = Vector(truth(server))
        val until = 60.seconds.fromNow
        while !flown.isCompleted && until.hasTimeLeft() do seen :+= truth(server)
        assertEquals(flown.value, Some(Success(Done)))
        def hovers(state: Kinematics) =
          (state.positionNed - Vector3(0, 0, -5)).norm < 2 && state.velocityNed.norm < 0.5
        assert(seen.exists(hovers), seen.takeRight(3).toString)
        assertEquals(server.peerStats.turnedAway, 1L)
        val next = SmallAutopilot()
        Await.ready(HilPeer.fly(next, 22_000_000, at, TcpTransport())(), 30.seconds)
        assert(next.heard.size > 100, "who comes later is served")

  test("noise over TCP ends its connection and is counted, and the next autopilot is served"):
    serving(AutopilotKind.Px4): server =>
      val at     = server.peerAddresses.head
      val random = Random(4560)
      val bad    = Socket(at.host, at.port)
      try for _ <- 1 to 500 do bad.getOutputStream.write(random.nextBytes(1 + random.nextInt(2000)))
      catch case _: java.io.IOException => ()
      bad.close()
      val autopilot    = SmallAutopilot()
      def come(): Unit =
        Await.ready(HilPeer.fly(autopilot, 5_000_000, at, TcpTransport())(), 20.seconds)
        if autopilot.heard.isEmpty then come()
      come()
      assert(autopilot.heard.nonEmpty)
      assert(server.peerStats.foreign > 0)

  test("ArduPilot's frames are answered over UDP, also among other datagrams"):
    serving(AutopilotKind.ArduPilot): server =>
      val socket = DatagramSocket(0, InetAddress.getLoopbackAddress)
      socket.setSoTimeout(5000)
      val at                       = server.peerAddresses.head
      val answer                   = DatagramPacket(new Array[Byte](2000), 2000)
      def send(bytes: Array[Byte]) =
        socket.send(DatagramPacket(bytes, bytes.length, InetAddress.getByName(at.host), at.port))
      for frame <- 0 until 500 do
        send(Array[Byte](1, 2, 3))
        send(ArduPilotInterfaceSuite.servos(frame, 1000, Seq(1000, 1000, 1000, 1000)))
        answer.setLength(2000)
        socket.receive(answer)
        val told = ujson.read(String(answer.getData, 0, answer.getLength))
        assertEqualsDouble(told("imu")("accel_body")(2).num, -9.8, 1)
      socket.close()
      // Before the first frame they belong to no autopilot.
      assertEquals((server.peerStats.damaged, server.peerStats.ignored), (499L, 1L))

  test("Betaflight receives the state on its port, and its controls turn the rotors"):
    val state = DatagramSocket(0, InetAddress.getLoopbackAddress)
    state.setSoTimeout(5000)
    serving(AutopilotKind.Betaflight, stateTo = Address("127.0.0.1", state.getLocalPort)): server =>
      val motors = DatagramSocket(0, InetAddress.getLoopbackAddress)
      val at     = server.peerAddresses.head
      val full   = java.nio.ByteBuffer.allocate(16).order(java.nio.ByteOrder.LITTLE_ENDIAN)
      for _ <- 1 to 4 do full.putFloat(0.9f)
      val packet = DatagramPacket(new Array[Byte](2000), 2000)
      val until  = 20.seconds.fromNow
      while truth(server).positionNed.z >= -0.5 && until.hasTimeLeft() do
        packet.setLength(2000)
        state.receive(packet)
        assertEquals(packet.getLength, 144)
        motors.send(DatagramPacket(full.array, 16, InetAddress.getByName(at.host), at.port))
      assert(truth(server).positionNed.z < -0.5, truth(server).toString)
      motors.close()
    state.close()
