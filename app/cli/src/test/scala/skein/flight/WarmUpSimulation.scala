package skein.flight

import java.util.concurrent.atomic.AtomicLong
import org.apache.pekko.actor.ActorSystem
import skein.link.{MemoryNetwork, NetworkPlan}
import skein.loop.LoopKind
import skein.signal.LatencyProfile
import skein.testing.Lengthy
import skein.units.*
import skein.vtime.VirtualTime

class WarmUpSimulation extends munit.FunSuite, Lengthy:
  private val settings =
    TwinFlights.settings(List(LoopKind.Paused, LoopKind.Stream), seconds = 60, LatencyProfile.vpn)

  /** A clock that advances by a second with each reading. */
  private def everySecond: Clock =
    val seconds = AtomicLong()
    Clock.ofNanos(() => Span.ofSeconds(seconds.getAndIncrement().toDouble).toNanos)

  test("a number of flights are run, and no more begin once it has lasted long enough"):
    assertEquals(WarmUp.fly(settings, flights = 1, everySecond), Right(1))
    assertEquals(WarmUp.fly(settings, flights = 20, everySecond), Right(WarmUp.AtMost.toSeconds.toInt - 1))

  test("every loop is rehearsed, with more decisions than a duel makes in a minute"):
    val decisions = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        val clock         = Clock.ofNanos(VirtualTime.clock(system))
        WarmUp.rehearse(settings, MemoryNetwork(NetworkPlan(), 1, clock).host("localhost"), clock)
      .value
    assert(decisions.exists(_ > 1200), decisions.toString)
