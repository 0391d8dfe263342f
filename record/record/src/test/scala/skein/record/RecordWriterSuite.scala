package skein.record

import java.util.concurrent.CountDownLatch
import scala.concurrent.Await
import scala.concurrent.duration.*

class RecordWriterSuite extends munit.FunSuite:

  test("a later row is made in its turn, by the thread that writes"):
    val batches       = Vector.newBuilder[Record]
    @volatile var who = Option.empty[Thread]
    val writer        = RecordWriter(8, 0, 8, Thread.ofPlatform().daemon().factory())(rows => {
      batches ++= rows; true
    })
    val rows = Samples.oneOfEach.take(3)
    assert(writer.offer(rows(0)))
    assert(writer.offer(LaterRow { who = Some(Thread.currentThread); rows(1) }))
    assert(writer.offer(rows(2)))
    writer.end()
    Await.result(writer.ended, 30.seconds)
    assertEquals(batches.result(), rows)
    assert(who.exists(_ != Thread.currentThread), "it was made by the thread that offered it")

  test("any error of the writing thread ends it, even a fatal one"):
    for error <- Seq(IllegalStateException("broken"), OutOfMemoryError("none left")) do
      val quiet: java.util.concurrent.ThreadFactory =
        Thread.ofPlatform().daemon().uncaughtExceptionHandler((_, _) => ()).factory()
      val writer = RecordWriter(8, 0, 8, quiet)(_ => throw error)
      assert(writer.offer(Samples.oneOfEach.head))
      val reason = Await.result(writer.ended.failed, 30.seconds)
      assertEquals(Option(reason.getCause).getOrElse(reason), error)
      assert((1 to 20).forall(_ => writer.offer(Samples.oneOfEach.head)), "later rows are ignored")

  test("all rows offered while a batch is written are in the next batch"):
    val (begun, goesOn) = (CountDownLatch(1), CountDownLatch(1))
    val batches         = Vector.newBuilder[Vector[Record]]
    val writer          = RecordWriter(8, 0, 8, Thread.ofPlatform().daemon().factory()): rows =>
      begun.countDown()
      goesOn.await()
      batches += rows
      true
    val rows = Samples.oneOfEach.take(3)
    assert(writer.offer(rows(0)))
    begun.await()
    assert(writer.offer(rows(1)))
    assert(writer.offer(rows(2)))
    goesOn.countDown()
    writer.end()
    Await.result(writer.ended, 30.seconds)
    assertEquals(batches.result(), Vector(rows.take(1), rows.drop(1)))
