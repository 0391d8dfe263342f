package skein.flight

import scala.concurrent.duration.*
import skein.cli.OurScenarios
import skein.loop.{LoopKind, Outcome, Replay}
import skein.measure.FlightSummary
import skein.recognition.BlindPursuit
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.*

/** The pursuer that knows of the evader by its camera alone, with rendering, links and recognition, in virtual time. */
class BlindPursuitSimulation extends munit.FunSuite:
  override def munitTimeout: Duration = 2.minutes

  private given Scenarios = OurScenarios.all

  private def settings(
      loop: LoopKind,
      seconds: Double,
      scenario: BlindPursuit = BlindPursuit()
  ) = FlySettings(
    List(loop),
    List(LatencyProfile.vpn),
    Span.ofSeconds(seconds),
    Span.ofMillis(100),
    seed = 3,
    scenario
  )

  private def fly(settings: FlySettings): VirtualFlightResult =
    val flown = VirtualFlights.fly(settings, settings.plans.last).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, Outcome.Completed)
    flown

  test(
    "predictive: the evader is found, believed where it is, and the flight repeats to the byte and decides the same"
  ):
    val blind     = settings(LoopKind.Predictive, 15)
    val flown     = fly(blind)
    val recording = flown.recorder.recording
    assertEquals(fly(blind).recorder.digest, flown.recorder.digest)
    assertEquals(Replay(blind.fleet, recording).firstDifference, None)
    val seen = FlightSummary.of(recording).seeing.headOption.getOrElse(fail("nothing was seen"))
    // Of 150 pictures.
    assert(clue(seen.pictures) > 100)
    assert(clue(seen.sights.size) > 0.7 * seen.pictures)
    assert(clue(seen.errorsM.get.median) < 0.25)
    // Recognition takes 15 to 120 ms, the way to and fro some 100 ms.
    assert(clue(seen.tookMs.get.least) >= 15 && clue(seen.tookMs.get.most) <= 120)
    assert(clue(seen.agesMs.get.median) > 60)
    assertEquals(seen.decisive.map(_._1).distinct.size, seen.decisive.size)

  for loop <- Seq(LoopKind.Sequential, LoopKind.Paused) do
    test(s"${loop.label}: the pursuer comes near by its camera alone"):
      val summary = FlightSummary.of(fly(settings(loop, 8)).recorder.recording)
      assert(summary.seeing.exists(_.sights.sizeIs > 20), s"${summary.seeing.map(_.sights.size)}")
      val closest = summary.result.flatMap(_.measured(1).value)
      assert(clue(closest).exists(_ < 12))
