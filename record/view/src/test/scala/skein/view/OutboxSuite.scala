package skein.view

import scala.util.Random

class OutboxSuite extends munit.FunSuite:
  private val limits = ViewerLimits(waiting = 3, waitingBytes = 100)

  private def drained(outbox: Outbox[String]): Vector[String] =
    Vector.unfold(outbox)(_.taken)

  test("waiting messages are sent in order of arrival, of any subscription"):
    val outbox = Outbox.empty[String](limits).offered(1, "a", 1).offered(2, "b", 1).offered(1, "c", 1)
    assertEquals(drained(outbox), Vector("a", "b", "c"))

  test("beyond a subscription's limit its oldest message is dropped, but no message of other subscriptions"):
    val outbox = (1 to 5).foldLeft(Outbox.empty[String](limits).offered(2, "quiet", 1))((all, at) =>
      all.offered(1, at.toString, 1)
    )
    assertEquals(drained(outbox), Vector("quiet", "3", "4", "5"))
    assertEquals(outbox.lost, 2L)

  test("beyond the total limit the oldest of all messages is dropped, but the newest is kept, however large"):
    val outbox = Outbox.empty[String](limits).offered(1, "old", 60).offered(2, "newer", 50)
    assertEquals((drained(outbox), outbox.lost, outbox.bytes), (Vector("newer"), 1L, 50L))
    assertEquals(drained(outbox.offered(3, "huge", 1000)), Vector("huge"))

  test("of messages that are useful only while newest, only the newest waits"):
    val outbox = (1 to 4).foldLeft(Outbox.empty[String](limits).offered(2, "row", 1))((all, at) =>
      all.offered(1, s"image $at", 10, most = 1)
    )
    assertEquals((drained(outbox), outbox.lost), (Vector("row", "image 4"), 3L))

  test("a notice is sent first, a newer one replaces it, and notices keep their order"):
    val outbox =
      Outbox.empty[String](limits).offered(1, "row", 1).noticed(
        "time",
        "5"
      ).noticed("info", "i").noticed("time", "6")
    assertEquals(drained(outbox), Vector("i", "6", "row"))

  test("an outbox is empty once neither a notice nor a row waits"):
    val empty = Outbox.empty[String](limits)
    assert(empty.isEmpty)
    for one <- Seq(empty.offered(1, "row", 1), empty.noticed("time", "5")) do
      assert(!one.isEmpty)
      assert(one.taken.exists(_._2.isEmpty))

  test("messages of a subscription that has ended are neither sent nor counted as lost"):
    val outbox = Outbox.empty[String](limits).offered(1, "a", 1).offered(2, "b", 1).unsubscribed(1)
    assertEquals((drained(outbox), outbox.lost, outbox.bytes), (Vector("b"), 0L, 1L))

  test("every message is taken once or dropped, and waiting ones stay within their bounds"):
    val random = Random(3)
    var outbox = Outbox.empty[Int](limits)
    var taken  = 0
    for number <- 1 to 20_000 do
      outbox = outbox.offered(random.nextInt(5), number, random.nextInt(40))
      if random.nextInt(3) == 0 then
        outbox.taken.foreach: (_, rest) =>
          taken += 1
          outbox = rest
      assert(outbox.bytes <= limits.waitingBytes, s"${outbox.bytes} bytes after $number")
      assertEquals(outbox.bytes, outbox.waiting.values.map(_.size.toLong).sum)
      assert(outbox.places.values.forall(_.size <= limits.waiting))
    assertEquals(taken + outbox.lost + outbox.waiting.size, 20_000L)
