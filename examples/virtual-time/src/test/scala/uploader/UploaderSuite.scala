package uploader

import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.vtime.VirtualTime

class UploaderSuite extends munit.FunSuite:
  test("an hour without the server loses nothing, and everything has arrived soon after"):
    val TwoHours(received, took, inVain, waiting) = TwoHours.of(seed = 1)
    assertEquals(received, (0 until 72_000).toVector)
    assert(took < 2.hours + 10.seconds, s"took $took")
    assert(inVain >= 10 && inVain <= Uploader.Attempts, s"asked $inVain times in vain")
    assert(waiting.map(_._2).max > 36_000 && waiting.last._2 < 100, waiting.last.toString)

  test("the same seed gives the same two hours, to the nanosecond"):
    assertEquals(TwoHours.of(seed = 5).took.toNanos, TwoHours.of(seed = 5).took.toNanos)

/** Ten samples per second; the server is unavailable from the 10th to the 70th minute.
  *
  * @param received by the server
  * @param inVain failed requests to it
  * @param waiting time in minutes and number of samples not yet received by the server, at the arrival of
  *   each batch
  */
final case class TwoHours(
    received: Vector[Int],
    took: FiniteDuration,
    inVain: Int,
    waiting: Vector[(Double, Double)]
)

object TwoHours:
  def of(seed: Long): TwoHours =
    var received = Vector.empty[Int]
    var waiting  = Vector.empty[(Double, Double)]
    var inVain   = 0
    val run      = VirtualTime.run(seed): system =>
      given ActorSystem                         = system
      val clock                                 = VirtualTime.clock(system)
      val start                                 = clock()
      def upload(batch: Seq[Int]): Future[Unit] =
        val seconds = (clock() - start) * 1e-9
        val minute  = seconds / 60
        def late    = (minute, 10 * seconds - received.size)
        if minute >= 10 && minute < 70 then
          inVain += 1
          Future.never
        else
          waiting :+= late
          received ++= batch
          waiting :+= late
          after(50.millis)(Future.unit)
      Source
        .tick(0.seconds, 100.millis, ())
        .zipWithIndex
        .map(_._2.toInt)
        .buffer(40_000, org.apache.pekko.stream.OverflowStrategy.fail)
        .take(72_000)
        .via(Uploader(upload))
        .runWith(Sink.seq)
    TwoHours(received, run.duration, inVain, waiting)

/** `./sbtw "virtualTime/Test/runMain uploader.draw"` draws the README's picture. */
@main def draw(): Unit =
  val points = TwoHours.of(seed = 1).waiting.map((minute, samples) =>
    f"${60 + minute * 5}%.1f,${260 - samples / 200}%.1f"
  )
  val svg =
    s"""<svg xmlns="http://www.w3.org/2000/svg" width="720" height="300" font-family="sans-serif" font-size="12">
       |<rect width="720" height="300" fill="#fff"/><rect x="110" y="60" width="300" height="200" fill="#f0f0f0"/>
       |<line x1="60" y1="260" x2="660" y2="260" stroke="#ccc"/><text x="50" y="264" text-anchor="end">0</text>
       |<text x="50" y="84" text-anchor="end">36,000</text><text x="260" y="55" text-anchor="middle">no server</text>
       |<polyline fill="none" stroke="#009e73" stroke-width="2" points="${points.mkString(" ")}"/>
       |<text x="360" y="290" text-anchor="middle">samples that wait, over two hours</text>
       |</svg>
       |""".stripMargin
  println(s"drawn in ${Files.writeString(Path.of("backlog.svg"), svg)}")
