package uploader

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.vtime.VirtualTime

class UploaderSuite extends munit.FunSuite:

  /** Ten samples a second for two hours; the server is away from the 10th to the 70th minute.
    *
    * @return
    *   what the server has received, after how long, and how often it was asked in vain
    */
  private def day(seed: Long): (Seq[Int], FiniteDuration, Int) =
    var received = Vector.empty[Int]
    var inVain   = 0
    val run      = VirtualTime.run(seed): system =>
      given ActorSystem                         = system
      val clock                                 = VirtualTime.clock(system)
      val start                                 = clock()
      def upload(batch: Seq[Int]): Future[Unit] =
        val minute = (clock() - start).nanos.toMinutes
        if minute >= 10 && minute < 70 then
          inVain += 1
          Future.never
        else
          received ++= batch
          after(50.millis)(Future.unit)
      Source
        .tick(0.seconds, 100.millis, ())
        .zipWithIndex
        .map(_._2.toInt)
        .buffer(40_000, org.apache.pekko.stream.OverflowStrategy.fail)
        .take(72_000)
        .via(Uploader(upload))
        .runWith(Sink.seq)
    (received, run.duration, inVain)

  test("an hour without the server loses nothing, and everything has arrived soon after"):
    val (received, took, inVain) = day(seed = 1)
    assertEquals(received, (0 until 72_000).toVector)
    assert(took < 2.hours + 10.seconds, s"took $took")
    assert(inVain >= 10 && inVain <= Uploader.Attempts, s"asked $inVain times in vain")

  test("the same seed gives the same two hours, to the nanosecond"):
    assertEquals(day(seed = 5)._2.toNanos, day(seed = 5)._2.toNanos)
