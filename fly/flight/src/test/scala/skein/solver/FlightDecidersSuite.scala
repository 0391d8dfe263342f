package skein.solver

import skein.loop.LoopKind
import skein.loop.planning.PlanWorkers
import skein.scenario.Crossing
import skein.settings.{FlySettings, RecordedPlan}
import skein.signal.LatencyProfile
import skein.units.Span

class FlightDecidersSuite extends munit.FunSuite:

  /** The vehicles decided for with the second one, and how often workers were made. */
  private def deciders(loop: LoopKind): (Vector[Int], Int) =
    val settings = FlySettings(
      List(loop),
      List(LatencyProfile.none),
      duration = Span.ofSeconds(4),
      period = Span.ofMillis(100),
      seed = 7,
      scenario = Crossing(vehicles = 4)
    )
    var made  = 0
    val works = RecordedPlan(settings, settings.plans.last)
    val found = FlightDeciders.of(works, _ => { made += 1; PlanWorkers.none }).fold(fail(_), identity)
    (found.together(1), made)

  test("only a loop that plans has workers, and decides for all vehicles that plan together"):
    assertEquals(deciders(LoopKind.Plan), (Vector(0, 1, 2, 3), 1))
    for loop <- Seq(LoopKind.Stream, LoopKind.Predictive) do assertEquals(deciders(loop), (Vector(1), 0))
