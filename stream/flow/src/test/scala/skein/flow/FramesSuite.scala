package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.signal.Stamped
import skein.units.*
import skein.vtime.VirtualTime

class FramesSuite extends munit.FunSuite:
  import Frames.Skipped

  private def ms(instant: Instant): Long = instant.toNanos / 1_000_000

  /** Requests a frame each 10 ms; `frames` has each one's exposure and the delay of its answer, ms, or a
    * failure.
    */
  private def taken(
      slow: FiniteDuration = Duration.Zero,
      inFlight: Int = 2
  )(frames: Either[String, (Int, Int)]*) =
    var skipped = Vector.empty[String]
    val came    = VirtualTime.run(seed = 1): system =>
      given ActorSystem                               = system
      val clock                                       = Clock.ofNanos(VirtualTime.clock(system))
      val start                                       = clock.now()
      val remaining                                   = frames.iterator
      def ask(): Future[Either[String, Stamped[Int]]] =
        val sent = Instant.Epoch + clock.now().since(start)
        remaining.next() match
          case Left(error)              => Future.successful(Left(error))
          case Right((exposure, delay)) =>
            val validAt = Instant.Epoch + Span.ofMillis(exposure)
            after(delay.millis)(
              Future.successful(Right(Stamped(exposure, validAt, sent, sent + Span.ofMillis(delay))))
            )
      def skip(what: Skipped[String, Int]) = skipped :+= (what match
        case Skipped.Missed(count)    => s"missed $count"
        case Skipped.Failed(error)    => error
        case Skipped.Overtaken(frame) => s"overtaken ${frame.value}"
        case Skipped.Repeated(frame)  => s"repeated ${frame.value}"
        case Skipped.Replaced(frame)  => s"replaced ${frame.value}")
      Frames
        .at(Source.tick(Duration.Zero, 10.millis, 1).take(frames.size).conflate(_ + _), inFlight)(() =>
          ask()
        )(skip)
        .mapAsync(1)(frame => after(slow)(Future.successful(frame)))
        .map(frame => ms(frame.validAt))
        .runWith(Sink.seq)
    (came.value, skipped)

  test("frames are stamped with their exposure, and emitted in the order of exposure"):
    assertEquals(taken()(Right(1, 5), Right(11, 5), Right(21, 5)), (Seq(1L, 11L, 21L), Vector.empty))

  test("a lost frame is reported and stops nothing"):
    assertEquals(taken()(Right(1, 5), Left("lost"), Right(21, 5)), (Seq(1L, 21L), Vector("lost")))

  test("a frame that arrives after a newer one is overtaken"):
    assertEquals(taken()(Right(1, 15), Right(11, 1), Right(21, 1)), (Seq(11L, 21L), Vector("overtaken 1")))

  test("an exposure received twice is emitted once, as when a lidar returns its last scan again"):
    assertEquals(taken()(Right(1, 1), Right(1, 1), Right(21, 1)), (Seq(1L, 21L), Vector("repeated 1")))

  test("the number of open requests is bounded, and missed ticks are counted"):
    val (came, skipped) = taken()(Right(1, 35), Right(11, 35), Right(41, 15), Right(51, 1))
    assertEquals(came, Seq(1L, 11L, 41L))
    assertEquals(skipped, Vector("missed 1"))

  test("a slow consumer gets the newest frame, and the replaced ones are reported"):
    val (came, skipped) = taken(slow = 33.millis)((0 until 10).map(i => Right((10 * i, 1)))*)
    assertEquals(came, Seq(0L, 30L, 60L, 90L))
    assertEquals(skipped, Vector(10, 20, 40, 50, 70, 80).map(i => s"replaced $i"))

  test("after a simulator restarts with an earlier clock, its frames are emitted"):
    assertEquals(taken()(Right(1000, 1), Right(5, 1), Right(15, 1)), (Seq(1000L, 5L, 15L), Vector.empty))
