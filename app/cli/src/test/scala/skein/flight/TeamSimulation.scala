package skein.flight

import java.nio.file.Files
import skein.loop.{LoopKind, FlightOutcome, Replay}
import skein.measure.FlightSummary
import skein.record.{EventKind, Recording}
import skein.report.PaperReport
import skein.scenario.*
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.testing.{Lengthy, Optimised, TemporaryFolders}
import skein.units.*

/** Scenarios of teams in virtual time. */
class TeamSimulation extends munit.FunSuite, TemporaryFolders, Lengthy, Optimised:
  private given Scenarios = PaperReport.scenarios

  private def settings(
      scenario: Scenario,
      loop: LoopKind,
      link: LatencyProfile,
      seconds: Double
  ) = FlySettings(
    List(loop),
    List(link),
    Span.ofSeconds(seconds),
    Span.ofMillis(100),
    1,
    scenario
  )

  private def fly(settings: FlySettings): Recording =
    val flown = VirtualFlights.fly(settings, settings.plans.head).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    flown.recorder.recording

  private def resultOf(recording: Recording): Result =
    FlightSummary.of(recording).result.getOrElse(fail("no result"))

  private def value(result: Result, name: String): Double =
    result.measured.find(
      _.measure.title == name
    ).flatMap(_.value).getOrElse(fail(s"no $name among ${result.measured}"))

  test("five pursuers surround the evader over the VPN"):
    val result = resultOf(fly(settings(Surround(), LoopKind.Predictive, LatencyProfile.vpn, 13)))
    assert(value(result, "surrounded after s") < 12, result.measured)

  test("a formation flies its circuit without a network"):
    val result = resultOf(fly(settings(Formation(), LoopKind.Stream, LatencyProfile.none, 18)))
    assert(value(result, "slot rms m") < 1.5, result.measured)

  test(
    "twenty vehicles cross over the VPN with at most ten commands per second each, none lost or refused"
  ):
    val recording = fly(settings(Crossing(), LoopKind.Predictive, LatencyProfile.vpn, 12))
    val result    = resultOf(recording)
    assert(value(result, "closest m") > 1, result.measured)
    val unwanted = recording.events.filter(_.kind != EventKind.Dropped)
    assert(unwanted.isEmpty, unwanted.take(5).mkString("\n"))
    assertEquals(recording.acknowledgements.size, recording.commands.size)
    for (vehicle, commands) <- recording.commands.groupBy(_.vehicle) do
      assert(commands.size <= 121 && commands.size > 80, s"$vehicle: ${commands.size} commands")
      val pauses = commands.map(_.sentAt).sorted.sliding(2).map(pair => pair(1).since(pair(0)))
      assert(pauses.forall(_ >= Span.ofMillis(20)), s"$vehicle is commanded faster than the rate cap allows")

  test("twenty planning vehicles cross over the VPN: they keep the separation and finish sooner"):
    val result = resultOf(fly(settings(Crossing(), LoopKind.Plan, LatencyProfile.vpn, 12.5)))
    assertEquals(value(result, "violations"), 0.0, result.measured)
    assert(value(result, "closest m") >= 2.5, result.measured)
    // Since their policy avoids collisions, none of them arrives before 13 s.
    assert(value(result, "arrived") >= 15, result.measured)

  test("a team that searches its plans for a long time surrounds the evader as closely as by its rule"):
    def offRing(loop: LoopKind) =
      val flown = settings(Surround(), loop, LatencyProfile.vpn, 20)
      value(resultOf(fly(flown.copy(planning = flown.planning.copy(slices = 20)))), "off ring m")
    val (planned, byRule) = (offRing(LoopKind.Plan), offRing(LoopKind.Predictive))
    assert(planned < byRule + 0.05, s"$planned m off the ring, by the rule $byRule m, seed 1")

  test("a formation that plans keeps its slots over the VPN"):
    val result = resultOf(fly(settings(Formation(), LoopKind.Plan, LatencyProfile.vpn, 24)))
    assert(value(result, "slot rms m") < 0.32, s"${result.measured}, seed 1")

  for (scenario, loop) <- Seq(
      Surround()             -> LoopKind.Paused,
      Formation()            -> LoopKind.Futures,
      Crossing(vehicles = 6) -> LoopKind.Stream,
      Crossing(vehicles = 6) -> LoopKind.Predictive,
      Crossing(vehicles = 6) -> LoopKind.Plan
    )
  do
    test(s"${scenario.name} by ${loop.label} has equal decisions in a replay and in a repeated flight"):
      val chosen   = settings(scenario, loop, LatencyProfile.vpn, 2)
      val plan     = chosen.plans.head
      val recorder = VirtualFlights.fly(chosen, plan).fold(fail(_), identity).recorder
      val folder   = temporaryFolder()
      val file     = plan.file(folder)
      try
        assert(recorder.writeTo(file).isRight)
        val replayed = Replayed.of(file).fold(fail(_), identity)
        assert(replayed.decisions > 50, replayed.toString)
        assertEquals(replayed.decidedAgain, None)
        assertEquals(replayed.flownAgain.map(_.again), Some(recorder.digest))
      finally
        Files.deleteIfExists(file): Unit
        Files.delete(folder)

  test("a replay finds a changed position of another vehicle of the team"):
    val flown     = settings(Surround(), LoopKind.Predictive, LatencyProfile.direct, 2)
    val recording = fly(flown)
    val forged    = recording.sightings.map(sighting =>
      if sighting.decision != 5 then sighting
      else
        sighting.copy(predicted =
          sighting.predicted.map(motion =>
            motion.copy(positionNed = motion.positionNed + Vector3(0.01, 0, 0))
          )
        )
    )
    assertEquals(Replay(flown.fleet, recording).firstDifference, None)
    val found = Replay(flown.fleet, recording.copy(sightings = forged)).firstDifference
    assert(found.exists(_.where.startsWith("decision 5 ")), found.toString)
