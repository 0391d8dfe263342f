package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import scala.concurrent.duration.*
import skein.units.*
import skein.vtime.VirtualTime

class DecideSuite extends munit.FunSuite:
  private val failure = RuntimeException("no plan")

  /** Decisions with their times in ms. The policy answers observation n with 10 n and the number of earlier
    * decisions, after a delay; a negative delay makes it throw.
    */
  private def decided(otherwise: OnOverrun[Int, Int, Int], delaysMs: Int*): Seq[(Long, DeadlineResult[Int])] =
    decidedBy(otherwise, asksAgain = false, delaysMs)

  private def decidedBy(otherwise: OnOverrun[Int, Int, Int], asksAgain: Boolean, delaysMs: Seq[Int]) =
    VirtualTime.run(seed = 1): system =>
      given ActorSystem                                  = system
      val clock                                          = Clock.ofNanos(VirtualTime.clock(system))
      val start                                          = clock.now()
      def policy(count: Int, n: Int): Future[(Int, Int)] =
        if delaysMs(n) < 0 then throw failure
        else after(delaysMs(n).millis)(Future.successful((count + 1, 10 * n + count)))
      Source
        .tick(0.millis, 100.millis, ())
        .zipWithIndex
        .map(_._2.toInt)
        .take(delaysMs.size)
        .via(Decide.within(Span.ofMillis(40), otherwise, start = 0, asksAgain)(policy))
        .map(timely => (clock.now().since(start).toNanos / 1_000_000, timely))
        .runWith(Sink.seq)
    .value

  import DeadlineResult.*

  test("a policy that answers in time decides"):
    assertEquals(decided(OnOverrun.Hold(), 0, 39), Seq(0L -> Decided(0), 139L -> Decided(11)))

  test(
    "a late policy is neither waited for nor called again until it has answered, and its answer is discarded"
  ):
    assertEquals(
      decided(OnOverrun.Hold(), 10, 250, 10, 10, 10),
      Seq(
        10L  -> Decided(0),
        140L -> Missed(Overrun.Late, None),
        200L -> Missed(Overrun.Busy, None),
        300L -> Missed(Overrun.Busy, None),
        410L -> Decided(41)
      )
    )

  test("a late policy that abandons an older observation is called again"):
    assertEquals(
      decidedBy(OnOverrun.Hold(), asksAgain = true, Seq(10, 250, 10, 10, 10)),
      Seq(
        10L  -> Decided(0),
        140L -> Missed(Overrun.Late, None),
        210L -> Decided(21),
        310L -> Decided(32),
        410L -> Decided(43)
      )
    )

  test("the last decision is repeated; before the first there is none"):
    assertEquals(
      decided(OnOverrun.Repeat(), 50, 10, 50, 10).map(_._2),
      Seq(Missed(Overrun.Late, None), Decided(10), Missed(Overrun.Late, Some(10)), Decided(31))
    )

  test("the fallback policy decides on the missed observation, with the shared memory"):
    assertEquals(
      decided(OnOverrun.Ask((count, n) => (count + 1, -n)), 10, 150, 10, 10).map(_._2),
      Seq(Decided(0), Missed(Overrun.Late, Some(-1)), Missed(Overrun.Busy, Some(-2)), Decided(33))
    )

  test("a policy that fails, or throws, counts as missed, and the flow continues"):
    assertEquals(
      decided(OnOverrun.Repeat(), 10, -1, 10),
      Seq(10L -> Decided(0), 100L -> Missed(Overrun.Failed(failure), Some(0)), 210L -> Decided(21))
    )
