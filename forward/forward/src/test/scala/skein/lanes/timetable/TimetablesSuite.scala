package skein.lanes.timetable

class TimetablesSuite extends munit.FunSuite:
  private def made(numbers: Int): Timetable =
    Timetable(1, Array.empty, 1, Array.ofDim(numbers), Array.empty, Array.empty, 0, 0)

  test("if episodes are used in rotation and do not all fit, some are still found in the cache"):
    val timetables = Timetables(mostBytes = 100 * made(10).bytes)
    var times      = 0
    for _ <- 1 to 20; episode <- 1 to 150 do
      val _ = timetables.getOrMake(episode):
        times += 1
        made(10)
    // The oldest first, all would be made 20 times; 100 of 150 have room.
    assert(clue(times) < 1800)

  test("a timetable that fits into the cache is made once, and one that does not fit is made each time"):
    val timetables           = Timetables(mostBytes = 3 * made(10).bytes)
    var times                = 0
    def get(of: Int)(n: Int) = timetables.getOrMake(of):
      times += 1
      made(n)
    for _ <- 1 to 5; episode <- 1 to 3 do get(episode)(10): Unit
    assertEquals(times, 3)
    assertEquals(get(4)(1000).times.length, 1000)
