package skein.ros

class LostMessagesSuite extends munit.FunSuite:
  private def lost(numbers: ((Long, Long), Long)*): Long =
    val messages = LostMessages()
    numbers.foreach(messages.add)
    messages.count

  private val (a, b) = ((1L, 1L), (1L, 2L))

  test("numbers that are missing between a publisher's messages count, before the first one none does"):
    assertEquals(lost(a -> 7, a -> 8, a -> 11), 2L)
    assertEquals(lost(a -> 7, b -> 3, a -> 8, b -> 5), 1L)

  test("without numbers, and after a late message, nothing more counts"):
    assertEquals(lost(a -> -1, a -> -1, a -> -1), 0L)
    assertEquals(lost(a -> 1, a -> 4, a -> 2, a -> 5), 2L)

  test("publishers beyond the most are forgotten, the oldest first"):
    val many = (0L to LostMessages.MostPublishers).map(index => (index, 0L) -> 1L)
    assertEquals(lost(many :+ ((0L, 0L) -> 9L)*), 0L)
    assertEquals(lost(many :+ ((1L, 0L) -> 9L)*), 7L)
