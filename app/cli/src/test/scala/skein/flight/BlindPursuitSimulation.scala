package skein.flight

import skein.cli.OurScenarios
import skein.forward.DelayTable
import skein.identify.SensorFit
import skein.lanes.{ScalarTeam, TeamCandidate}
import skein.loop.{LoopKind, FlightOutcome, Replay}
import skein.measure.{FlightSummary, RecordedSeeing}
import skein.optimise.DistanceTerm
import skein.policy.Role
import skein.recognition.BlindPursuit
import skein.scenario.Scenarios
import skein.search.Conditions
import skein.settings.{FlySettings, SensorFile}
import skein.signal.LatencyProfile
import skein.simd.WorldRandom
import skein.testing.{Lengthy, Optimised}
import skein.torture.Torture
import skein.units.*

/** A pursuer that observes the evader only through its camera, with rendering, links and recognition, in
  * virtual time.
  */
class BlindPursuitSimulation extends munit.FunSuite, Lengthy, Optimised:
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
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    flown

  private def twentySeconds(loop: LoopKind) = fly(settings(loop, 20)).recorder.recording
  private lazy val predictive               = twentySeconds(LoopKind.Predictive)

  test("predictive: repeated flights are identical to the byte"):
    val digests = Seq.fill(2)(fly(settings(LoopKind.Predictive, 4)).recorder.digest)
    assertEquals(digests.distinct.size, 1)

  test("predictive: the evader is detected and estimated correctly, and a replay repeats all decisions"):
    val recording = predictive
    assertEquals(Replay(settings(LoopKind.Predictive, 20).fleet, recording).firstDifference, None)
    val seen = FlightSummary.of(recording).seeing.headOption.getOrElse(fail("nothing was seen"))
    // Of 200 images.
    val images = seen.images.getOrElse(fail("nothing was seen"))
    assert(clue(images) > 150)
    assert(clue(seen.detections.size) > 0.7 * images)
    assert(clue(seen.errorsM.get.median) < 0.25)
    // Recognition takes 15 to 120 ms, the round trip some 100 ms.
    assert(clue(seen.tookMs.get.least) >= 15 && clue(seen.tookMs.get.most) <= 120)
    assert(clue(seen.agesMs.get.median) > 60)
    assertEquals(seen.decisive.map(_._1).distinct.size, seen.decisive.size)

  for loop <- Seq(LoopKind.Stream, LoopKind.Predictive) do
    test(s"${loop.label}: a sensor model fitted to a flight has the flight's effect in forward simulation"):
      val recording = if loop == LoopKind.Predictive then predictive else twentySeconds(loop)
      val fit       = SensorFit.of(RecordedSeeing.of(recording)).fold(fail(_), identity)
      assert(fit.model.detection > 0.7 && fit.model.bearingSdRad < 0.01 && fit.model.rangeSd < 0.03, s"$fit")
      assertEqualsDouble(fit.model.rangeBias, 1, 0.01)
      val again =
        SensorFile.parse(SensorFile.render(fit, Vector("a recording")), "sensor.conf").fold(fail(_), identity)
      assertEqualsDouble(again.bearingSdRad, fit.model.bearingSdRad, 1e-5)
      assertEqualsDouble(again.takes.mean.toMillis, fit.model.takes.mean.toMillis, 0.1)
      val conditions = Conditions(loop.label, "drag", 100, 20).resolved.fold(fail(_), identity)
      val scalar     = ScalarTeam(conditions.timing, conditions.vehicle.response)
      val seeing     = conditions.game.seeing(Role.Pursuer, Some(again))
      val team       = TeamCandidate(seeing, DistanceTerm.Last10s.judged(seeing.durationS, 0.1).toVector)
      def last10sM(world: Int) = scalar.fly(team, DelayTable.vpn, WorldRandom.key(1, 0, world))(0)
      val foreseen             = (1 to 8).map(last10sM).sum / 8
      val came                 = FlightSummary.of(recording).headline.getOrElse(fail("no distance"))
      assertEqualsDouble(clue(foreseen), came, 0.07 * came)

  test("with faults of the link, the messages and the simulator, control keeps its rules"):
    for seed <- Seq(3L, 5L) do
      val verdict = Torture.of(seed, Span.ofSeconds(8), Some(BlindPursuit()))
      assertEquals(verdict.violations, Vector.empty, verdict.faultPlan.toString)

  for loop <- Seq(LoopKind.Sequential, LoopKind.Paused) do
    test(s"${loop.label}: the pursuer approaches the evader using only its camera"):
      val summary = FlightSummary.of(fly(settings(loop, 8)).recorder.recording)
      assert(summary.seeing.exists(_.detections.sizeIs > 20), s"${summary.seeing.map(_.detections.size)}")
      val closest = summary.result.flatMap(_.measured(1).value)
      assert(clue(closest).exists(_ < 12))
