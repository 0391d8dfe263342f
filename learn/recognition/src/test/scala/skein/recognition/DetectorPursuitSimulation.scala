package skein.recognition

import skein.flight.VirtualFlights
import skein.loop.{LoopKind, FlightOutcome}
import skein.measure.FlightSummary
import skein.scenario.{ScenarioKind, Scenarios}
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

/** A whole flight whose pursuer observes its evader only by the shipped detector, in virtual time. */
class DetectorPursuitSimulation extends munit.FunSuite, Unhurried:
  private given Scenarios = Scenarios(Vector(ScenarioKind(BlindPursuit())))

  test("the detector finds an evader without tags, and the pursuer approaches it"):
    val settings = FlySettings(
      List(LoopKind.Predictive),
      List(LatencyProfile.direct),
      Span.ofSeconds(8),
      Span.ofMillis(100),
      seed = 3,
      BlindPursuit(recogniser = "detector")
    )
    val flown = VirtualFlights.fly(settings, settings.plans.last).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    val summary = FlightSummary.of(flown.recorder.recording)
    val seen    = summary.seeing.headOption.getOrElse(fail("nothing was seen"))
    assert(clue(seen.images).exists(clue(seen.detections.size) > 0.6 * _))
    assert(clue(summary.result.flatMap(_.measured(1).value)).exists(_ < 12))
