package skein.experiment

import java.util.concurrent.atomic.AtomicLong
import skein.link.Clock
import skein.loop.LoopKind
import skein.signal.LatencyProfile
import skein.units.*

class WarmUpSimulation extends munit.FunSuite:
  private val settings =
    TwinFlights.settings(List(LoopKind.Paused, LoopKind.Stream), seconds = 60, LatencyProfile.vpn)

  /** A second passes from reading to reading. */
  private def everySecond: Clock =
    val seconds = AtomicLong()
    Clock.ofNanos(() => Span.ofSeconds(seconds.getAndIncrement().toDouble).toNanos)

  test("so many flights are flown, and no more begin when it has lasted long enough"):
    assertEquals(WarmUp.fly(settings, flights = 3, everySecond), Right(3))
    assertEquals(WarmUp.fly(settings, flights = 20, everySecond), Right(WarmUp.AtMost.toSeconds.toInt - 1))
