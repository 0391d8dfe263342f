package skein.simulator

import scala.collection.mutable

class BesideSuite extends munit.FunSuite:
  private final class Table(most: Int):
    val begun                                 = mutable.Queue.empty[Runnable]
    val beside                                = Beside(begun.enqueue(_): Unit, most)
    val done                                  = mutable.ArrayBuffer.empty[String]
    def put(client: Long, what: String): Unit = beside.put(client)(done += what: Unit)

  test("work is done for the clients in turn, on as many threads as allowed"):
    val table = Table(most = 2)
    for i <- 1 to 3 do table.put(1, s"a$i")
    for i <- 1 to 2 do table.put(2, s"b$i")
    assertEquals(table.begun.size, 2)
    table.begun.dequeue().run()
    assertEquals(table.done.sorted.toSeq, Seq("a1", "a2", "a3", "b1", "b2"))
    assertEquals(table.done.last, "a3", "no client waits for all that another has asked for")
    table.begun.dequeue().run()
    table.put(1, "later")
    assertEquals(table.begun.size, 1)

  test("the work of a client that has left is not begun, and a failure does not stop other work"):
    val table = Table(most = 1)
    table.put(1, "gone")
    table.beside.forget(1)
    table.beside.put(2)(throw IllegalStateException("broken"))
    table.put(3, "done")
    intercept[IllegalStateException](table.begun.dequeue().run())
    while table.begun.nonEmpty do table.begun.dequeue().run()
    assertEquals(table.done.toSeq, Seq("done"))
