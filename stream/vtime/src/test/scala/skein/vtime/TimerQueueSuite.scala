package skein.vtime

class TimerQueueSuite extends munit.FunSuite:
  private val nothing: Runnable = () => ()

  test("timers leave by time, and at equal times in the order in which they were set"):
    val timers = TimerQueue()
    val added  = Seq(30L, 10L, 20L, 10L, 30L, 10L).map(timers.add(_, nothing))
    assertEquals(timers.removeAll(), Seq(1, 3, 5, 2, 0, 4).map(added))

  test("cancelled timers are never returned, and do not accumulate"):
    val timers = TimerQueue()
    val kept   = timers.add(1_000_000, nothing)
    (1 to 100_000).foreach: due =>
      timers.cancel(timers.add(due, nothing))
      assert(timers.size <= 2 + TimerQueue.slack + 1, s"${timers.size} timers are held where one is wanted")
    assertEquals(timers.removeAll(), Seq(kept))

  test("a cancelled timer at the head is skipped"):
    val timers       = TimerQueue()
    val Seq(a, b, c) = Seq(1L, 2L, 3L).map(timers.add(_, nothing)): @unchecked
    timers.cancel(a)
    assertEquals(timers.head, Some(b))
    timers.removeHead()
    assertEquals(timers.removeAll(), Seq(c))
