package skein.ros

class LostMessagesSuite extends munit.FunSuite:
  private def lost(numbers: ((Long, Long), Long)*): Long =
    val messages = LostMessages()
    numbers.foreach(messages.add)
    messages.count

  private val (a, b) = ((1L, 1L), (1L, 2L))

  test("missing numbers between a publisher's messages count as lost, missing numbers before them do not"):
    assertEquals(lost(a -> 7, a -> 8, a -> 11), 2L)
    assertEquals(lost(a -> 7, b -> 3, a -> 8, b -> 5), 1L)

  test("messages without numbers, and late messages, do not count as lost"):
    assertEquals(lost(a -> -1, a -> -1, a -> -1), 0L)
    assertEquals(lost(a -> 1, a -> 4, a -> 2, a -> 5), 2L)

  test("beyond the limit of publishers the oldest is forgotten"):
    val many = (0L to LostMessages.MostPublishers).map(index => (index, 0L) -> 1L)
    assertEquals(lost(many :+ ((0L, 0L) -> 9L)*), 0L)
    assertEquals(lost(many :+ ((1L, 0L) -> 9L)*), 7L)
