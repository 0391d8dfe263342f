package skein.vtime

import scala.concurrent.duration.*
import skein.vtime.Watchdog.{Look, isEndless, standsStill}

class WatchdogSuite extends munit.FunSuite:

  private val still = Look(waits = true, begun = 7, processorNanos = 1_000)

  test("a thread that waits in one task without processor time in between stands still"):
    assert(standsStill(Seq(still, still, still)))

  test("two observations are not enough"):
    assert(!standsStill(Seq(still, still)))

  test("a thread that used the processor between observations is not stuck, even if each finds it waiting"):
    assert(!standsStill(Seq(still, still.copy(processorNanos = 1_001), still.copy(processorNanos = 1_002))))
    assert(!standsStill(Seq(still, still, still.copy(processorNanos = 1_001))))

  test("a thread that has begun another task, or is observed running, does not stand still"):
    assert(!standsStill(Seq(still, still, still.copy(begun = 8))))
    assert(!standsStill(Seq(still, still.copy(waits = false), still)))

  test(
    "a thread that computes in one task all the time is endless, but not one that computes from time to time"
  ):
    def looks(processorMs: Long*) =
      processorMs.map(ms => Look(waits = false, begun = 7, processorNanos = ms * 1_000_000))
    assert(isEndless(looks(0, 4_900, 9_800), 10.seconds))
    assert(!isEndless(looks(0, 9_800), 10.seconds))
    assert(!isEndless(looks(0, 1_000, 4_000), 10.seconds))
    assert(!isEndless(looks(0, 4_900) ++ looks(9_800).map(_.copy(begun = 8)), 10.seconds))
    assert(!isEndless(looks(0, 0, 0).map(_.copy(processorNanos = -1)), 10.seconds))
