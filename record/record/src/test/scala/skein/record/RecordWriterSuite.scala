package skein.record

import scala.concurrent.Await
import scala.concurrent.duration.*

class RecordWriterSuite extends munit.FunSuite:

  test("a row that is made later is made by the thread that writes, in its turn"):
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
