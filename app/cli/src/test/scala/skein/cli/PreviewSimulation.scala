package skein.cli

import java.util.concurrent.ConcurrentLinkedQueue
import scala.concurrent.duration.*
import skein.flight.VirtualFlights
import skein.loop.LoopKind
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.*

class PreviewSimulation extends munit.FunSuite:
  override val munitTimeout: Duration = 3.minutes

  private given Scenarios = Scenarios.ours

  private def at(seconds: Double): Clock = () => Instant.ofNanos(Span.ofSeconds(seconds).toNanos)

  private val settings = FlySettings(
    List(LoopKind.Paused, LoopKind.Stream),
    List(LatencyProfile.vpn),
    Span.ofSeconds(12),
    Span.ofMillis(100),
    seed = 5
  )
  private val twins = settings.plans.flatMap(_.twins(1))

  test("previews are simulated only if the warm-up's flights show that a whole flight is short"):
    val minute = Span.ofSeconds(60)
    assert(Preview.fits(20, Span.ofSeconds(3), minute))
    assert(Preview.fits(7, Span.ofSeconds(3), minute))
    assert(!Preview.fits(5, Span.ofSeconds(3), minute))
    assert(!Preview.fits(20, Span.ofSeconds(3), Span.ofSeconds(600)))
    assert(!Preview.fits(0, Span.Zero, minute))
    assert(Preview.fits(20, Span.ofSeconds(3), Span.ofSeconds(2)))

  test("previewed twins equal those of the report, with a line for each and its result"):
    val said  = ConcurrentLinkedQueue[String]()
    val flown = Preview.fly(settings, twins, at(0))(line => said.add(line): Unit)
    assertEquals(flown.keySet, twins.toSet)
    for plan <- twins do
      val again = VirtualFlights.fly(settings, plan).map(_.recorder.digest)
      assertEquals(Right(flown(plan).recorder.digest), again)
    val lines = said.toArray.toVector.map(_.toString)
    assert(lines.exists(_.matches("in virtual time, stream over vpn: last 10 s [0-9.]+ m")), lines)
    assertEquals(lines.size, 2, lines)

  test("no preview starts after the time for previews has elapsed"):
    var looks        = 0
    val clock: Clock = () =>
      looks += 1
      Instant.ofNanos(Preview.AtMost.toNanos * (looks - 1))
    assertEquals(Preview.fly(settings, twins.take(1), clock)(_ => ()), Map.empty)
