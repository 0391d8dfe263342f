package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.duration.*
import scala.concurrent.Future
import skein.units.*
import skein.vtime.VirtualTime

class SenseSuite extends munit.FunSuite:

  /** Answers with the request's number after its delay; above 500 ms with an error at 500 ms. */
  private def sensed(window: Int, early: Sense.Early, isNewer: Option[(Int, Int) => Boolean] = None)(
      delaysMs: Long*
  ) =
    var skipped = Vector.empty[Either[String, Int]]
    var missed  = 0
    val emitted = VirtualTime.run(seed = 1): system =>
      given ActorSystem                      = system
      val clock                              = Clock.ofNanos(VirtualTime.clock(system))
      val start                              = clock.now()
      var asked                              = -1
      def ask(): Future[Either[String, Int]] =
        asked += 1
        val number = asked
        val delay  = delaysMs.applyOrElse(number, _ => 10L)
        if delay > 500 then after(500.millis)(Future.successful(Left(s"late $number")))
        else after(delay.millis)(Future.successful(Right(number)))
      def skip(answer: Either[String, Int]) = skipped :+= answer
      def miss(ticks: Int)                  =
        assert(ticks > 0, "what was not missed was told")
        missed += ticks
      val answers = isNewer match
        case None =>
          Sense.every(Span.ofMillis(100), Span.ofMillis(50), window, early)(() => ask())(skip, miss)
        case Some(newer) =>
          val ticks = Source.tick(50.millis, 100.millis, 1).conflate(_ + _)
          Sense.at(ticks, window, early, newer)(() => ask())(skip, miss)
      answers
        .map(number => (clock.now().since(start).toNanos / 1_000_000, number))
        .take(6)
        .runWith(Sink.seq)
    (emitted.value, skipped, missed)

  test("with Waits, an answer is emitted once all answers to older requests have arrived"):
    val (emitted, skipped, missed) = sensed(4, Sense.Early.Waits)(10, 250, 10, 10)
    assertEquals(emitted, Seq(60L -> 0, 400L -> 1, 400L -> 2, 400L -> 3, 460L -> 4, 560L -> 5))
    assertEquals((skipped, missed), (Vector.empty, 0))

  test("a lost answer is skipped and counted, and later ones are emitted"):
    val (emitted, skipped, _) = sensed(8, Sense.Early.Waits)(10, 9999, 10, 10, 10, 10, 10)
    assertEquals(emitted.map(_._2), Seq(0, 2, 3, 4, 5, 6))
    assertEquals(emitted(1)._1, 650L)
    assertEquals(skipped, Vector(Left("late 1")))

  test("a tick that finds the window full is missed and counted"):
    val (emitted, _, missed) = sensed(1, Sense.Early.Waits)(10, 350, 10)
    assertEquals(emitted.map(_._2), Seq(0, 1, 2, 3, 4, 5))
    assertEquals(emitted(1)._1, 500L)
    assertEquals(missed, 2)

  test(
    "with Overtakes, an answer is emitted immediately, and an answer that it overtook is skipped and counted"
  ):
    val (emitted, skipped, _) = sensed(4, Sense.Early.Overtakes)(10, 250, 10, 10)
    assertEquals(emitted.map(_._2), Seq(0, 2, 3, 4, 5, 6))
    assertEquals(emitted(1), 260L -> 2)
    assertEquals(skipped, Vector(Right(1)))

  test("with Overtakes, an answer to an older request is emitted if it is valid at a later time"):
    val later                 = (one: Int, other: Int) => one == 1 && other == 2
    val (emitted, skipped, _) = sensed(4, Sense.Early.Overtakes, Some(later))(10, 250, 10, 240, 10)
    assertEquals(emitted.map(_._2), Seq(0, 2, 1, 4, 5, 6))
    assertEquals(skipped, Vector(Right(3)))

  test("a newer answer to an older request does not admit answers that were overtaken before"):
    val later                 = (one: Int, other: Int) => one == 1 && other == 3
    val (emitted, skipped, _) = sensed(4, Sense.Early.Overtakes, Some(later))(10, 250, 200, 10, 10)
    assertEquals(emitted.map(_._2), Seq(0, 3, 1, 4, 5, 6))
    assertEquals(skipped, Vector(Right(2)))
