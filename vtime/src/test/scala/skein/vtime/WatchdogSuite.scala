package skein.vtime

import skein.vtime.Watchdog.{Look, standsStill}

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
