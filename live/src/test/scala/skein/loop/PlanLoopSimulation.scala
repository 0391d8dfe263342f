package skein.loop

import skein.record.EventKind
import skein.signal.LatencyProfile
import skein.units.*

class PlanLoopSimulation extends munit.FunSuite:

  private lazy val duel = VirtualDuel.fly(LoopKind.Plan, LatencyProfile.vpn, seed = 4)

  private def distances(duel: VirtualDuel): Vector[Double] =
    duel.recording.decisions
      .filter(_.vehicle == "Pursuer")
      .map(decision => math.hypot(decision.relativeX.value, decision.relativeY.value))

  test("over vpn the planning pursuer captures the paper's evader and flies at half the paper's distance"):
    assertEquals(duel.outcome, Outcome.Completed)
    val closest = distances(duel).min
    assert(closest < 1.5, s"seed 4: closest $closest m")
    val papers = VirtualDuel.fly(LoopKind.Stream, LatencyProfile.vpn, seed = 4).distanceM
    assert(duel.distanceM < papers / 2, s"seed 4: ${duel.distanceM} m on the average of the last 10 s")

  test("every decision of the pursuer is planned, by the slices that are set, and leaves at the deadline"):
    val planning  = LoopSettings().planning
    val decisions = duel.recording.decisions.filter(_.vehicle == "Pursuer").map(_.sequence)
    assertEquals(duel.recording.planned.map(_.decision), decisions)
    val slices = Vector.fill(planning.searches)(planning.slices).mkString(",")
    assertEquals(duel.recording.planned.map(_.slices).distinct, Vector(slices))
    assertEquals(duel.recording.planned.map(_.took).distinct, Vector(planning.deadline))
    assertEquals(duel.recording.events.filter(_.kind == EventKind.DeadlineMissed), Vector.empty)

  test("the pursuer keeps its turning circle"):
    val most  = 10.0 / LoopSettings().planning.turningRadiusM
    val turns = duel.recording.decisions.filter(_.vehicle == "Pursuer").drop(1)
    for turn <- turns do
      val turned = math.abs(turn.heading.value - turn.headingBefore.value)
      assert(turned <= most * turn.elapsed.toSeconds + 1e-9, s"decision ${turn.sequence} turns by $turned")

  test("where no slice is ready the last plan goes on, and every such deadline is counted"):
    val starved = LoopSettings(planning = PlanSettings(slices = 1))
    val flown   = VirtualDuel.fly(LoopKind.Plan, LatencyProfile.direct, 5, starved, slices = 0)
    val missed  = flown.recording.events.filter(_.kind == EventKind.DeadlineMissed)
    assertEquals(missed.size, flown.recording.planned.size)
    assert(missed.nonEmpty)

  test("a geofence is kept while the evader flees across it"):
    val fenced = LoopSettings(planning = PlanSettings(geofenceM = 60))
    val flown  = VirtualDuel.fly(LoopKind.Plan, LatencyProfile.direct, 6, fenced)
    val places = flown.recording.readings.filter(_.vehicle == "Pursuer").map(_.state.value.positionNed)
    for place <- places do
      assert(math.max(place.x.abs, place.y.abs) < 60.5, s"seed 6: at ${place.x}, ${place.y}")

  test("settings survive their text"):
    val settings =
      PlanSettings(deadline = Span.ofMillis(31.25), method = PlanSettings.PathIntegral, slices = 9)
    assertEquals(PlanSettings.parse(settings.text), Some(settings))
    assertEquals(PlanSettings.parse(settings.copy(behaviours = 0).text), None)
    assertEquals(PlanSettings.parse("nothing"), None)
