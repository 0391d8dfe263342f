package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.units.*
import skein.vtime.VirtualTime

class MetronomeSuite extends munit.FunSuite:

  /** Times of emissions in ms, with their numbers of ticks, for a source that starts `startsAt` after the
    * first was due and takes `slow` for each.
    */
  private def ticked(startsAt: FiniteDuration, slow: FiniteDuration): Seq[(Long, Int)] =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock = Clock.ofNanos(VirtualTime.clock(system))
        val first = clock.now()
        after(startsAt)(Future.unit).flatMap: _ =>
          Source
            .fromGraph(Metronome(first, Span.ofMillis(100), clock))
            .map(ticks => (clock.now().since(first).toNanos / 1_000_000, ticks))
            .mapAsync(1)(tick => after(slow)(Future.successful(tick)))
            .take(4)
            .runWith(Sink.seq)
      .value

  test("ticks are at whole periods after the first, whenever the source started"):
    assertEquals(ticked(0.millis, Duration.Zero), Seq(0L -> 1, 100L -> 1, 200L -> 1, 300L -> 1))
    assertEquals(ticked(37.millis, Duration.Zero), Seq(100L -> 1, 200L -> 1, 300L -> 1, 400L -> 1))
    assertEquals(ticked(200.millis, Duration.Zero), Seq(200L -> 1, 300L -> 1, 400L -> 1, 500L -> 1))
    assertEquals(ticked(200.millis + 1.nano, Duration.Zero), Seq(300L -> 1, 400L -> 1, 500L -> 1, 600L -> 1))

  test("ticks add up while downstream is slow"):
    assertEquals(ticked(0.millis, 260.millis), Seq(0L -> 1, 260L -> 2, 520L -> 3, 780L -> 2))

  test("an invalid period is refused"):
    intercept[IllegalArgumentException](Metronome(Instant.Epoch, Span.Zero, Clock.ofNanos(() => 0L))): Unit
