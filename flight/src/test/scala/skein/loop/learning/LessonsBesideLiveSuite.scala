package skein.loop.learning

import java.util.concurrent.{CountDownLatch, Executors, TimeUnit}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext}

class LessonsBesideLiveSuite extends munit.FunSuite:

  test("a learner that hangs delays nobody; what is not learned from is counted"):
    given system: ActorSystem = ActorSystem("lessons")
    val thread                = Executors.newSingleThreadExecutor()
    val (began, goOn)         = (CountDownLatch(1), CountDownLatch(1))
    val learner: FlownLearner = _ =>
      began.countDown()
      goOn.await()
      None
    try
      val lessons    = LessonsBeside(learner, ExecutionContext.fromExecutor(thread))
      val transition = Transition(Vector(1), 0, Vector(2), 3)
      lessons.flown(transition)
      assert(began.await(10, TimeUnit.SECONDS))
      // While it hangs, all that follow return, more than ever wait.
      for _ <- 1 to 5 * LessonsBeside.MostWaiting do lessons.flown(transition)
      val lost = Iterator
        .continually(lessons.news(1))
        .flatten
        .map(_.text)
        .take(1)
        .toVector
      assert(lost.head.contains("flown decisions are not learned from"), lost)
    finally
      goOn.countDown()
      thread.shutdownNow(): Unit
      Await.result(system.terminate(), 10.seconds): Unit
