package skein.vtime

import java.util.concurrent.CountDownLatch
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future}
import skein.testing.Unhurried

/** Needs the real clock: shows that real time advances independently of virtual time. */
class RealClockLiveSuite extends munit.FunSuite, Unhurried:

  test("a task that waits for a latch is ended, and its stack is shown"):
    val error = intercept[VirtualTimeException]:
      VirtualTime.run(1, RunLimits(standstill = 100.millis)): _ =>
        CountDownLatch(1).await()
        Future.unit
    assertEquals(error.problem, Problem.Stuck(100.millis))
    assert(error.getCause.getStackTrace.exists(_.getClassName.contains("RealClockLiveSuite")))
    assert(!Thread.currentThread.isInterrupted)

  test("an ordinary actor system in the same JVM keeps real time while hours of virtual time pass"):
    given live: ActorSystem = ActorSystem("live")
    try
      val start     = System.nanoTime()
      val throttled =
        Source(1 to 3).throttle(1, 100.millis).map(_ => System.nanoTime() - start).runWith(Sink.seq)
      VirtualTime.run(1)(system => after(5.hours)(Future.unit)(using system)): Unit
      val emitted = Await.result(throttled, 10.seconds).map(_ / 1_000_000)
      assert(clue(emitted).last >= 190 && emitted.last < 5000)
    finally Await.result(live.terminate(), 10.seconds): Unit
