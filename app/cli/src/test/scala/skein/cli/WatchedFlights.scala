package skein.cli

import java.lang.management.{ManagementFactory, MemoryType}
import java.net.Socket
import java.nio.charset.StandardCharsets.US_ASCII
import java.nio.file.{Files, Path}
import java.util.concurrent.atomic.AtomicLong
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.record.{FlightTopics, RecordingReader}
import skein.report.PaperReport
import skein.scenario.Scenarios

/** The delays of a flight's requests after their ticks, from its recording.
  *
  * @param p99Ms 99th percentile
  */
final case class Lateness(questions: Int, p50Ms: Double, p99Ms: Double, mostMs: Double)

object Lateness:

  /** Computes delays. Ticks are whole periods apart; the phase is that of the most punctual requests. */
  def of(file: Path): Lateness =
    val recorded =
      RecordingReader.read(file).fold(error => throw IllegalStateException(error.message), identity)
    val period = recorded.flight.period.toNanos
    // The first second belongs to the start.
    val sent   = recorded.readings.map(_.state.sentAt.toNanos).sorted
    val steady = sent.filter(_ > sent.head + 1_000_000_000L)
    val phases = steady.map(_ % period)
    // Signed, around the circle, from the phase that is nearest to all.
    def after(one: Long, other: Long) = Math.floorMod(other - one + period / 2, period) - period / 2
    val middle                        = phases.minBy(one => phases.map(after(one, _).abs).sum)
    val sorted                        = phases.map(after(middle, _) * 1e-6).sorted
    val late                          = sorted.map(_ - sorted((sorted.size - 1) / 100))
    def quantile(share: Double)       = late(((late.size - 1) * share).round.toInt)
    Lateness(late.size, quantile(0.5), quantile(0.99), late.last)

/** Viewers that subscribe to every topic and discard the data: all at full speed, except one that reads a
  * byte a second.
  */
final class Viewers(port: Int, count: Int) extends AutoCloseable:
  val bytes: AtomicLong    = AtomicLong()
  @volatile private var on = true
  private val sockets      = Vector.fill(count)(Socket("127.0.0.1", port))

  sockets.zipWithIndex.foreach: (socket, index) =>
    val out = socket.getOutputStream
    out.write((s"GET / HTTP/1.1\r\nHost: 127.0.0.1:$port\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" +
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n" +
      "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n").getBytes(US_ASCII))
    out.flush()
    // Bytes before the server's answer do not belong to the WebSocket.
    val answer = Iterator.continually(socket.getInputStream.read()).takeWhile(_ >= 0).map(_.toChar)
    answer.scanLeft("")((last, next) => (last + next).takeRight(4)).find(_ == "\r\n\r\n"): Unit
    // Channel numbers start at 1; unknown ones are refused, and only a few are tried.
    val topics = FlightTopics.all(Vector("Evader", "Pursuer")).size + 1
    val wanted = (1 to topics).map(at => s"""{"id":$at,"channelId":$at}""").mkString(",")
    val text   = s"""{"op":"subscribe","subscriptions":[$wanted]}""".getBytes(US_ASCII)
    out.write(Array(0x81, 0xfe, text.length >> 8, text.length, 0, 0, 0, 0).map(_.toByte))
    out.write(text)
    out.flush()
    Thread.ofVirtual().start: () =>
      try
        val in     = socket.getInputStream
        val buffer = new Array[Byte](if index == 0 then 1 else 65536)
        while on && { val read = in.read(buffer); bytes.addAndGet(read.max(0)): Unit; read >= 0 } do
          if index == 0 then Thread.sleep(1000)
      catch case _: java.io.IOException => ()

  def close(): Unit =
    on = false
    sockets.foreach(_.close())

/** A flight without viewers and with ten, in turns: `cli/Test/runMain skein.cli.watchedFlights 30 3`. */
@main def watchedFlights(seconds: Int, rounds: Int): Unit =
  given Scenarios = PaperReport.scenarios
  val folder      = Files.createTempDirectory("watched")
  for round <- 1 to rounds; viewers <- Seq(0, 10) do
    val out    = folder.resolve(s"$round-$viewers")
    val flying =
      ViewLiveSuite.Flying.start(out, "--loop", "predictive", "--link", "none", "--duration", s"${seconds}s")
    flying.awaitStart("predictive-none")
    val bytes = Using.resource(Viewers(flying.port, viewers)): watching =>
      flying.land()
      watching.bytes.get
    val heap = ManagementFactory.getMemoryPoolMXBeans.asScala
      .filter(pool => pool.getType == MemoryType.HEAP && pool.getCollectionUsage != null)
      .map(_.getCollectionUsage.getUsed)
      .sum
    val late = Lateness.of(out.resolve("predictive-none.duckdb"))
    println(
      f"$viewers%2d viewers: ${late.questions}%,d questions, late p50 " +
        f"${late.p50Ms}%.2f, p99 ${late.p99Ms}%.2f, most ${late.mostMs}%.2f ms; " +
        f"$bytes%,d bytes seen; heap ${heap >> 20} MiB after its last collection"
    )
