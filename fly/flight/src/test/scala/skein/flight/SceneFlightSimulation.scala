package skein.flight

import skein.loop.{LoopKind, FlightOutcome, Replay}
import skein.record.EventKind
import skein.scenario.{Forest, PaperDuel, Scenarios}
import skein.settings.{FlySettings, NamedScene, RecordedPlan}
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

/** Flights among obstacles that vehicles can touch. */
class SceneFlightSimulation extends munit.FunSuite, Unhurried:
  private given Scenarios = Scenarios.ours

  private def settings(loop: LoopKind, duration: Span) =
    FlySettings(List(loop), List(LatencyProfile.vpn), duration, Span.ofMillis(100), seed = 1)

  private def fly(settings: FlySettings): VirtualFlightResult =
    VirtualFlights.fly(settings, settings.plans.last).fold(fail(_), identity)

  private def contacts(flown: VirtualFlightResult) =
    flown.recorder.recording.events.filter(_.kind == EventKind.Contact)

  test("a duel among trees records every contact, and the scene"):
    val duel = settings(LoopKind.Stream, Span.ofSeconds(20))
      .copy(scenario = PaperDuel(altitudeM = 5), scene = NamedScene.shipped("forest"))
    val flown = fly(duel)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    assert(contacts(flown).nonEmpty, "nobody touched a tree")
    assert(contacts(flown).forall(_.detail.startsWith("Tree")), contacts(flown).map(_.detail).mkString("; "))
    val recording = flown.recorder.recording
    assertEquals(RecordedPlan.of(recording).map(_.settings.world.name), Right("forest"))
    assertEquals(fly(duel).recorder.digest, flown.recorder.digest)

  test("a duel in an empty world sends no requests for contacts"):
    val flown = fly(settings(LoopKind.Stream, Span.ofSeconds(2)))
    assertEquals(contacts(flown).size, 0)
    assertEquals(flown.recorder.recording.heading.parameters.filter(_.name.startsWith("scene")), Seq.empty)

  for loop <- Seq(LoopKind.Stream, LoopKind.Predictive) do
    test(
      s"${loop.label}: scouts cross the forest using only lidar, touch nothing, and replay to equal decisions"
    ):
      val crossing = settings(loop, Span.ofSeconds(45)).copy(scenario = Forest(vehicles = 2))
      val flown    = fly(crossing)
      assertEquals(flown.landed.outcome, FlightOutcome.Completed)
      assertEquals(contacts(flown).map(_.detail).toVector, Vector.empty)
      val recording = flown.recorder.recording
      val last      = recording.readings.groupBy(_.vehicle).values.map(_.last.state.value.positionNed.x)
      assert(last.forall(_ > 112), s"they came to $last m")
      assertEquals(Replay(crossing.fleet, recording).firstDifference, None)

  test("contacts with one object within half a second count once, others separately"):
    val tree = skein.airsim.Collision(Instant.ofNanos(0), Vector3.Zero, Vector3.Zero, "Tree1")
    assert(ContactWatch.isNew(tree, None))
    assert(!ContactWatch.isNew(tree.copy(at = Instant.Epoch + Span.ofMillis(500)), Some(tree)))
    assert(ContactWatch.isNew(tree.copy(at = Instant.Epoch + Span.ofMillis(501)), Some(tree)))
    assert(ContactWatch.isNew(tree.copy(objectName = "Tree2"), Some(tree)))
