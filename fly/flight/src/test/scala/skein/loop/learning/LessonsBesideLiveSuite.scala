package skein.loop.learning

import java.util.concurrent.{ConcurrentLinkedQueue, CountDownLatch, Executors, TimeUnit}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext}
import scala.jdk.CollectionConverters.*

class LessonsBesideLiveSuite extends munit.FunSuite:

  test("a learner that hangs delays no decision; skipped transitions are counted"):
    given system: ActorSystem = ActorSystem("lessons")
    val thread                = Executors.newSingleThreadExecutor()
    val (began, goOn)         = (CountDownLatch(1), CountDownLatch(1))
    val learner: FlownLearner = _ =>
      began.countDown()
      goOn.await()
      None
    try
      val lessons    = LessonsBeside(learner, ExecutionContext.fromExecutor(thread))
      val transition = Transition(Vector(1), Vector(0), Vector(2), 3)
      lessons.flown(transition)
      assert(began.await(10, TimeUnit.SECONDS))
      // While it hangs, all later calls return, more than the queue holds.
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

  test("a long lesson is learned part by part, in order, and its last version counts"):
    given system: ActorSystem = ActorSystem("lessons")
    val thread                = Executors.newSingleThreadExecutor()
    val (began, goOn)         = (CountDownLatch(1), CountDownLatch(1))
    val parts                 = ConcurrentLinkedQueue[Vector[Transition]]()
    val all                   = CountDownLatch(101)
    val learner: FlownLearner = part =>
      began.countDown()
      goOn.await()
      parts.add(part)
      part.foreach(_ => all.countDown())
      Some(Vector(part.last.distanceM))
    try
      val lessons                  = LessonsBeside(learner, ExecutionContext.fromExecutor(thread))
      def flown(number: Int): Unit = lessons.flown(Transition(Vector(1), Vector(0), Vector(2), number))
      flown(0)
      assert(began.await(10, TimeUnit.SECONDS))
      for number <- 1 to 100 do flown(number)
      goOn.countDown()
      assert(all.await(10, TimeUnit.SECONDS))
      assertEquals(parts.asScala.flatten.map(_.distanceM).toVector, (0 to 100).map(_.toDouble).toVector)
      assert(parts.asScala.forall(_.sizeIs <= 8), parts.asScala.map(_.size))
      val newest = Iterator.continually(lessons.news(1)).flatten.flatMap(_.parameters).find(_.head == 100)
      assertEquals(newest, Some(Vector(100.0)))
    finally
      goOn.countDown()
      thread.shutdownNow(): Unit
      Await.result(system.terminate(), 10.seconds): Unit
