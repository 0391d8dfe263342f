package skein.planning

import skein.vehicle.{PlaneReading, ReducedModel}

class JointPlannerSuite extends munit.FunSuite:
  private val settings  = PlannerSettings(steps = 30, blocksPerSlice = 1, stepsPerKnot = 3)
  private val minimumM  = 2.0
  private val objective = PlanCost(
    CommandLimits(0, 10, 4),
    carried = 0.5,
    turning = 0.005,
    speedChange = 0.1,
    cruiseSpeed = 8,
    separation = SeparationCost(minimumM, margin = 0.8)
  )

  private def vehicle(at: PlaneReading) = PredictedVehicle(ReducedModel.airSimAt(5), at)

  private def part(
      from: PlaneReading,
      headingRad: Double,
      toX: Double,
      toY: Double,
      stepsFlown: Int,
      self: Int
  ) =
    val goal = PredictedTrack.standing(toX, toY, settings.steps)
    Part(
      objective,
      Situation(vehicle(from), headingRad, settings.dtS, Vector(Behaviour(Target.Along(goal)))),
      stream = 1_000L * stepsFlown + self
    )

  private val count = 6

  private def bearing(self: Int): Double = self * 2 * math.Pi / count

  /** Start of a vehicle on a circle, heading for the centre; its goal is on the opposite side. */
  private def start(self: Int): PlaneReading =
    val (cos, sin) = (math.cos(bearing(self)), math.sin(bearing(self)))
    PlaneReading(-25 * cos, -25 * sin, 8 * cos, 8 * sin)

  /** Simulates all vehicles under their plans, which are renewed in each step with this number of slices.
    * Returns the smallest separation and the largest final distance to a goal, m.
    */
  private def fly(slices: Int, seconds: Int): (Double, Double) =
    val planner                           = JointPlanner()
    val motions                           = Array.tabulate(count)(start)
    val headings                          = Array.tabulate(count)(bearing)
    var last                              = Option.empty[JointPlan]
    var least                             = Double.PositiveInfinity
    def goal(self: Int): (Double, Double) = (-start(self).northM, -start(self).eastM)
    for flown <- 0 until seconds * 10 do
      val parts = Vector.tabulate(count)(self =>
        part(motions(self), headings(self), goal(self)._1, goal(self)._2, flown, self)
      )
      val problem = PlanProblem(settings, parts)
      val found   = planner.searched(problem, planner.resumed(problem, last), 0, slices)
      last = Some(found)
      for self <- 0 until count do
        val action =
          PlannedMove.of(found.plans(self), found.situation(self, parts(self)), objective, settings.dtS)
        headings(self) += action.turned
        val (north, east) = (action.speed * math.cos(headings(self)), action.speed * math.sin(headings(self)))
        motions(self) = vehicle(motions(self)).flown(north, east, settings.dtS).motion
      for one <- 0 until count; other <- 0 until one do
        val (a, b) = (motions(one), motions(other))
        least = math.min(least, math.hypot(a.northM - b.northM, a.eastM - b.eastM))
    (
      least,
      (0 until count).map(self =>
        math.hypot(motions(self).northM - goal(self)._1, motions(self).eastM - goal(self)._2)
      ).max
    )

  test("six vehicles whose straight tracks meet in one point keep apart and reach their goals"):
    val (least, left) = fly(slices = count, seconds = 11)
    assert(least >= minimumM, s"$least m apart")
    assert(left < 3, s"$left m from the goal")

  test("vehicles keep apart even if a tick has slices for only a third of them"):
    val (least, _) = fly(slices = count / 3, seconds = 7)
    assert(least >= minimumM, s"$least m apart")

  test("vehicles take turns, and the next search begins with the vehicle after the last"):
    val planner = JointPlanner()
    val problem = PlanProblem(
      settings,
      Vector.tabulate(3)(self => part(start(self), bearing(self), 0, 30, stepsFlown = 0, self))
    )
    val found = planner.searched(problem, planner.resumed(problem, None), 0, slices = 4)
    assertEquals(found.plans.map(_.slices), Vector(2, 1, 1))
    val next = planner.searched(problem, planner.resumed(problem, Some(found)), 0, slices = 1)
    assertEquals(next.plans.map(_.slices), Vector(0, 1, 0))

  test("each vehicle keeps apart from the others' plans; one without separation ignores them"):
    val planner = JointPlanner()
    val careful = part(start(0), bearing(0), 25, 0, stepsFlown = 0, self = 0)
    val blind   = careful.copy(objective = objective.copy(separation = SeparationCost(0)))
    val problem = PlanProblem(settings, Vector(careful, blind))
    val plan    = planner.resumed(problem, None)
    assertEquals(plan.situation(0, careful).others, Vector(plan.tracks(1)))
    assertEquals(plan.situation(1, blind).others, Vector.empty)

  test("the best of several searches is the one with the lowest total cost, and all candidates are counted"):
    val planner = JointPlanner()
    val problem = PlanProblem(
      settings,
      Vector.tabulate(3)(self => part(start(self), bearing(self), 0, 30, stepsFlown = 0, self))
    )
    val warm  = planner.resumed(problem, None)
    val found = Vector(planner.searched(problem, warm, 0, 1), planner.searched(problem, warm, 1, 12))
    val best  = JointPlanner.best(problem, found)
    val costs = found.map(_.cost(problem.parts, settings.dtS))
    assertEquals(best.cost(problem.parts, settings.dtS), costs.min)
    assertEquals(best.plans.map(_.candidates).sum, 13L * settings.sliceCandidates)

  test("equal problems and numbers of slices give equal plans, to the last bit"):
    val problem = PlanProblem(
      settings,
      Vector.tabulate(4)(self => part(start(self), bearing(self), 5, 5, stepsFlown = 0, self))
    )
    def turns =
      val planner = JointPlanner()
      planner
        .searched(problem, planner.resumed(problem, None), 1, 6)
        .plans
        .map(_.manoeuvre.turnRates.toSeq)
    assertEquals(turns, turns)
