package skein.loop

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Failure, Success, Try}
import skein.units.*
import skein.vtime.VirtualTime

/** A command that must not get lost is repeated, with pauses, and a limited number of times. */
class UntilCertainSuite extends munit.FunSuite:

  /** Times of the attempts, ms, and the final result. Even numbers are certain. */
  private def told(answer: Int => Try[Int]): (Vector[Double], Try[Int]) = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val start              = clock.now()
      var times              = Vector.empty[Double]
      def attempt()          =
        times :+= clock.now().since(start).toMillis
        Future.fromTry(answer(times.size))
      UntilCertain(attempt())(_ % 2 == 0).transform(result => Success((times, result)))
    .value

  test("a command is repeated until an answer is certain, and not if the first one is"):
    assertEquals(told(_ => Success(8)), (Vector(0.0), Success(8)))
    val pauseMs = UntilCertain.Pause.toMillis
    assertEquals(told(count => Success(count + 3)), (Vector(0.0), Success(4)))
    assertEquals(
      told(count => if count < 3 then Success(1) else Success(6)),
      (Vector(0.0, pauseMs, 2 * pauseMs), Success(6))
    )

  test("a failure is not certain, and the last attempt's answer is returned in any case"):
    val lost  = Failure(IllegalStateException("lost"))
    val never = told(_ => lost)
    assertEquals((never._1.size, never._2), (UntilCertain.Attempts, lost))
    val uncertain = told(Success(_))
    assertEquals(uncertain._2, Success(2))
    assertEquals(told(count => Success(2 * count + 1))._2, Success(2 * UntilCertain.Attempts + 1))
