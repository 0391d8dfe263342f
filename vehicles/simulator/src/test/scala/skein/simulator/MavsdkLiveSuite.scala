package skein.simulator

import java.net.{DatagramPacket, DatagramSocket, InetAddress}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.util.Random
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.{Address, TcpTransport}
import skein.mavlink.*
import skein.testing.{Conclusive, Lengthy, PythonEnvironment, Waiting}
import skein.units.*

/** Proof that the built-in simulator's vehicles speak MAVLink: MAVSDK's C++ library, from PyPI, controls
  * three simultaneously. Runs if Python can install that package; it fetches it once per user.
  */
class MavsdkLiveSuite extends munit.FunSuite, Conclusive, Lengthy, Waiting:
  private given system: ActorSystem = ActorSystem("mavsdk")

  override def afterAll(): Unit =
    val _ = Await.result(system.terminate(), 20.seconds)

  private val vehicles = Vector.tabulate(3)(index => VehicleSettings(s"v$index", Vector3(0, 10 * index, 0)))

  private def serving[A](mavlink: MavlinkSettings, speed: Double = 1)(use: SimulatorServer => A): A =
    val settings = SimulatorSettings(
      WorldSettings(vehicles),
      Address("127.0.0.1", 0),
      speed = speed,
      mavlink = Some(mavlink)
    )
    val server = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
    try use(server)
    finally
      val _ = Await.result(server.close(), 10.seconds)

  /** Currently unused UDP ports. */
  private def freePorts(count: Int): Vector[Int] =
    val sockets = Vector.fill(count)(DatagramSocket(0, InetAddress.getLoopbackAddress))
    try sockets.map(_.getLocalPort)
    finally sockets.foreach(_.close())

  test(
    "MAVSDK arms three vehicles together, takes off, flies velocities, positions and a mission, and lands"
  ):
    Mavsdk.python(): Unit
    conclusive:
      val ports = freePorts(3)
      val open  = ports.zipWithIndex.map((port, index) =>
        MavlinkPort(Address("127.0.0.1", 0), Some(Address("127.0.0.1", port)), Vector(index + 1))
      )
      serving(MavlinkSettings(udp = open), speed = 3): _ =>
        val (status, output) = Mavsdk.run("fly_mavsdk.py", ports.map(_.toString)*)
        println(output)
        assertEquals(status, 0, output)
        assert(output.linesIterator.exists(_.matches("PASSED [0-9]{2,} checks in .* s")), output)

  test("pymavlink decodes every message that the vehicles send, of every kind"):
    Pymavlink.python(): Unit
    conclusive:
      val port = freePorts(1).head
      val open = MavlinkPort(Address("127.0.0.1", port), systems = Vector(1))
      serving(MavlinkSettings(udp = Vector(open)), speed = 4): _ =>
        val (status, output) = Pymavlink.run("decode_mavlink.py", port.toString)
        println(output)
        assertEquals(status, 0, output)
        assert(output.linesIterator.exists(_.matches("PASSED [0-9]{3,} messages of 24 kinds")), output)

  test("a thousand damaged datagrams of each kind leave the vehicles answering, and other peers unharmed"):
    val port = freePorts(1).head
    serving(MavlinkSettings(udp = Vector(MavlinkPort(Address("127.0.0.1", port))))): server =>
      val to     = Address("127.0.0.1", port)
      val bad    = Peer(to)
      val good   = Peer(to)
      val random = Random(7)
      val writer = FrameWriter(245, 190)
      // A peer is known from its first whole message on.
      assert(bad.isAnswered(0))
      for definition <- Dialect.all do
        for count <- 1 to 1000 do
          val frame = writer.write(definition.decode(random.nextBytes(definition.length)))
          frame(random.nextInt(frame.length)) = random.nextInt(256).toByte
          bad.send(frame.take(1 + random.nextInt(frame.length)))
          // At most this many may wait for the server: later ones would be lost.
          if count % 200 == 0 then assert(bad.isAnswered(definition.id + count), definition.name)
        assert(good.isAnswered(definition.id), definition.name)
      bad.close()
      good.close()
      assertEquals(server.peerStats.ignored, 0L)

  private final class Peer(to: Address):
    private val socket = DatagramSocket(0, InetAddress.getLoopbackAddress)
    private val writer = FrameWriter(246, 190)
    private val reader = FrameReader()
    socket.setSoTimeout(5000)

    def send(bytes: Array[Byte]): Unit =
      socket.send(DatagramPacket(bytes, bytes.length, InetAddress.getByName(to.host), to.port))

    /** Whether a TIMESYNC of this number is answered within 5 s. */
    def isAnswered(number: Long): Boolean =
      val packet   = DatagramPacket(new Array[Byte](1 << 16), 1 << 16)
      val until    = 5.seconds.fromNow
      var isHere   = false
      var askAgain = Deadline.now
      while !isHere && until.hasTimeLeft() do
        // Not for every telemetry message: that many requests would overload a busy server.
        if askAgain.isOverdue() then
          send(writer.write(Timesync(0, 1000 + number)))
          askAgain = 1.second.fromNow
        packet.setLength(1 << 16)
        socket.receive(packet)
        isHere = reader.readDatagram(packet.getData.take(packet.getLength)).exists(_.message match
          case Timesync(_, theirs, _, _) => theirs == 1000 + number
          case _                         => false)
      isHere

    def close(): Unit = socket.close()

private val Mavsdk = PythonEnvironment("mavsdk", Some("/mavlink/fly_mavsdk.py"), Seq("mavsdk==4.1.0"))

private val Pymavlink =
  PythonEnvironment("pymavlink", Some("/mavlink/decode_mavlink.py"), Seq("pymavlink==2.4.50"))
