package skein.vtime

import scala.concurrent.duration.*
import skein.vtime.Watchdog.{Look, isEndless, standsStill}

class WatchdogSuite extends munit.FunSuite:

  private val still = Look(waits = true, begun = 7, processorNanos = 1_000)

  test("a thread that waits in the same task and has no processor time in between stands still"):
    assert(standsStill(Seq(still, still, still)))

  test("two looks are not enough"):
    assert(!standsStill(Seq(still, still)))

  test("a thread that is met waiting every time but has worked in between does not stand still"):
    assert(!standsStill(Seq(still, still.copy(processorNanos = 1_001), still.copy(processorNanos = 1_002))))
    assert(!standsStill(Seq(still, still, still.copy(processorNanos = 1_001))))

  test("nor does one that has begun another task, or that is met running"):
    assert(!standsStill(Seq(still, still, still.copy(begun = 8))))
    assert(!standsStill(Seq(still, still.copy(waits = false), still)))

  test(
    "a thread that computes in the same task all the time does not end; one that computes now and then may"
  ):
    def looks(processorMs: Long*) =
      processorMs.map(ms => Look(waits = false, begun = 7, processorNanos = ms * 1_000_000))
    assert(isEndless(looks(0, 4_900, 9_800), 10.seconds))
    assert(!isEndless(looks(0, 9_800), 10.seconds))
    assert(!isEndless(looks(0, 1_000, 4_000), 10.seconds))
    assert(!isEndless(looks(0, 4_900) ++ looks(9_800).map(_.copy(begun = 8)), 10.seconds))
    assert(!isEndless(looks(0, 0, 0).map(_.copy(processorNanos = -1)), 10.seconds))
