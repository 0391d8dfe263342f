package skein.loop.planning

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.duration.*
import skein.flight.FlightAssembler
import skein.planning.*
import skein.testing.Optimised
import skein.units.*
import skein.vehicle.{PlaneReading, ReducedModel}
import skein.vtime.VirtualTime

class PlanSuite extends munit.FunSuite, Optimised:
  private val settings  = PlannerSettings(blocksPerSlice = 1)
  private val objective = PlanCost(CommandLimits.paperPursuer, cruiseSpeed = 10)
  private val goal      = Target.Along(PredictedTrack.standing(10, 10, settings.steps))

  private def situation(headingRad: Double): Situation =
    Situation(
      PredictedVehicle(ReducedModel.AirSim, PlaneReading(0, 0, 5, 0)),
      headingRad,
      0.1,
      Vector(Behaviour(goal))
    )

  /** Each answer's time in ms and first turn, with the heading as memory. */
  private def planned(workers: PlanWorkers, ticks: Int): Seq[(Long, PlanStage.Answer)] =
    VirtualTime.run(seed = 1): system =>
      given ActorSystem = system
      val clock         = Clock.ofNanos(VirtualTime.clock(system))
      val start         = clock.now()
      Source
        .tick(0.millis, 100.millis, ())
        .zipWithIndex
        .map(_._2)
        .take(ticks)
        .via(PlanStage.within(Span.ofMillis(60), workers, settings, 0.0)(
          (headingRad, tick: Long) => Vector(Part(objective, situation(headingRad), tick)),
          (headingRad, _, parts, answer: PlanStage.Answer) =>
            val action = PlannedMove.of(answer.best.plans(0), parts(0).situation, objective, settings.dtS)
            (headingRad + action.turned, answer)
        ))
        .map(answer => (clock.now().since(start).toNanos / 1_000_000, answer))
        .runWith(Sink.seq)
    .value

  test("a plan is emitted at its deadline, with the configured slices"):
    val answers = planned(CountedPlanWorkers(searches = 2, slices = 3), ticks = 4)
    assertEquals(answers.map(_._1), Seq(60L, 160L, 260L, 360L))
    assertEquals(answers.map(_._2.slices).distinct, Seq(Vector(3, 3)))
    assert(answers.forall(!_._2.isMissed(0)))

  test("equal slices give equal plans, to the last bit"):
    def turns = planned(CountedPlanWorkers(2, 3), ticks = 3).map(_._2.best.plans(0).manoeuvre.turnRates.toSeq)
    assertEquals(turns, turns)

  test("a plan continues the remainder of the previous one: without a slice, that is executed to its end"):
    val workers = new PlanWorkers:
      private val first                                            = CountedPlanWorkers(1, 5)
      private val none                                             = CountedPlanWorkers(1, 0)
      private var begun                                            = 0
      def begin(problem: PlanProblem, warm: JointPlan): PlanSearch =
        begun += 1
        if begun == 1 then first.begin(problem, warm) else none.begin(problem, warm)
      def close(): Unit = ()
    val Seq(best, next, last) = planned(workers, ticks = 3).map(_._2): @unchecked
    assert(!best.isMissed(0) && next.isMissed(0) && last.isMissed(0))
    assertEquals(
      next.best.plans(0).manoeuvre.turnRates.toSeq,
      best.best.plans(0).manoeuvre.shifted(0.1, settings.dtS).turnRates.toSeq
    )
    assertEquals(
      last.best.plans(0).manoeuvre.turnRates.toSeq,
      next.best.plans(0).manoeuvre.shifted(0.1, settings.dtS).turnRates.toSeq
    )
    assertEquals(Seq(best, next, last).map(_.unsearchedS), Seq(Vector(0.0), Vector(0.1), Vector(0.2)))

  test("after a pause, a plan continues where the previous one has got to"):
    val problem = PlanProblem(settings, Vector(Part(objective, situation(0), 0)))
    val best    = JointPlanner().searched(problem, JointPlanner().resumed(problem, None), 0, 5)
    val pause   = PlanProblem(
      settings,
      problem.parts.map(part => part.copy(situation = part.situation.copy(sinceDecisionS = 0.8)))
    )
    assertEquals(
      JointPlanner().resumed(pause, Some(best)).plans(0).manoeuvre.turnRates.toSeq,
      best.plans(0).manoeuvre.shifted(0.8, settings.dtS).turnRates.toSeq
    )
    val last = PlanStage.Answer(best, Vector(5), Vector(0))
    val none = JointPlanner().resumed(pause, Some(best))
    assertEquals(PlanStage.Answer.of(Vector(none), pause, Some(last)).unsearchedS, Vector(0.8))

  test("several vehicles share the configured slices, each with an equal number"):
    val problem = PlanProblem(settings, Vector.tabulate(2)(n => Part(objective, situation(n), n)))
    val warm    = JointPlanner().resumed(problem, None)
    for (slices, each) <- Seq(0 -> 0, 1 -> 1, 2 -> 1, 3 -> 2) do
      val found = CountedPlanWorkers(1, slices).begin(problem, warm).finish().head
      assertEquals((found.slices, found.plans.map(_.slices)), (2 * each, Vector(each, each)))

  test("before the first search, the time since the last search is infinite"):
    val answers = planned(CountedPlanWorkers(1, 0), ticks = 2).map(_._2.unsearchedS)
    assertEquals(answers, Seq.fill(2)(Vector(Double.PositiveInfinity)))

  test("workers accept from one search to a problem's limit"):
    def made(count: Int): Seq[() => PlanWorkers] =
      Seq(
        () => CountedPlanWorkers(count, slices = 1),
        () => ThreadedPlanWorkers(count, FlightAssembler.planThreads("skein-plan"))
      )
    for make <- Seq(1, PlanProblem.MostSearches).flatMap(made) do make().close()
    for make <- Seq(0, PlanProblem.MostSearches + 1).flatMap(made) do
      intercept[IllegalArgumentException](make()): Unit
    intercept[IllegalArgumentException](CountedPlanWorkers(1, slices = -1)): Unit
