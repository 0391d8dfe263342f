package skein.planning

import skein.scenario.Fence
import skein.policy.PaperEvader
import skein.vehicle.{PlaneReading, ReducedModel}

class PlannerSuite extends munit.FunSuite:
  private def vehicle(north: Double, east: Double, northMps: Double, eastMps: Double) =
    PredictedVehicle(ReducedModel.AirSim, PlaneReading(north, east, northMps, eastMps))

  private val objective = PlanCost(CommandLimits.paperPursuer, cruiseSpeed = 10)
  private val evader    =
    Target.Opponent(vehicle(15, 3, 4, 0), speed = 5, headingRad = 0, PaperEvader())
  private val pursuit = Situation(vehicle(0, 0, 8, 0), 0, 0.1, Vector(Behaviour(evader)))

  private def improved(planner: Planner, situation: Situation, slices: Int, stream: Long = 1): Plan =
    Iterator.iterate(planner.start)(planner.improve(_, situation, stream)).drop(slices).next()

  private def costs(manoeuvre: Manoeuvre, situation: Situation, planner: Planner): Double =
    ManoeuvreRollout(situation, planner.objective, planner.settings.dtS).fly(manoeuvre).cost

  private val settings = PlannerSettings()

  test("equal streams and slices give equal plans, to the last bit"):
    val (one, other) = (
      improved(Planner(settings, objective), pursuit, 5),
      improved(Planner(settings, objective), pursuit, 5)
    )
    assertEquals(one.manoeuvre.turnRates.toSeq, other.manoeuvre.turnRates.toSeq)
    assertEquals(one.cost, other.cost)
    assertEquals(one.candidates, 5L * settings.sliceCandidates)

  test("another random stream draws other candidates"):
    val planner = Planner(settings, objective)
    assertNotEquals(
      improved(planner, pursuit, 1, stream = 1).manoeuvre.turnRates.toSeq,
      improved(planner, pursuit, 1, stream = 2).manoeuvre.turnRates.toSeq
    )

  test("slices never make a plan worse, and its cost is that of its manoeuvre"):
    val planner = Planner(settings, objective)
    val plans   = Iterator.iterate(planner.start)(planner.improve(_, pursuit, 3)).slice(1, 8).toVector
    for (before, after) <- plans.zip(plans.drop(1)) do assert(after.cost <= before.cost)
    assertEqualsDouble(plans.last.cost, costs(plans.last.manoeuvre, pursuit, planner), 1e-3)
    assert(plans.last.cost < costs(planner.start.manoeuvre, pursuit, planner))

  test("ten slices find a manoeuvre at least as good as 30,000 random ones"):
    val planner  = Planner(settings, objective)
    val blind    = Planner(settings.copy(blocksPerSlice = 256), objective)
    val found    = improved(planner, pursuit, 10)
    val stumbled = improved(blind, pursuit, 1)
    assert(found.cost <= stumbled.cost + 1e-3f, s"${found.cost} against ${stumbled.cost}")

  test("a plan resumed after a tick starts with a lower cost than a new plan"):
    val planner = Planner(settings, objective)
    val plan    = improved(planner, pursuit, 10)
    val flown   = pursuit.copy(own = vehicle(0.8, 0, 8, 0))
    val warm    = costs(planner.resumed(plan, 0.1).manoeuvre, flown, planner)
    assert(warm < costs(planner.start.manoeuvre, flown, planner))

  test("a plan respects the turning radius and keeps apart from other vehicles"):
    val separation = SeparationCost(minimum = 2, margin = 1)
    val settings   = PlannerSettings(steps = 40)
    val objective  = PlanCost(CommandLimits(3, 6, 1, 4), cruiseSpeed = 6, separation = separation)
    val planner    = Planner(settings, objective)
    val goal       = PredictedTrack.standing(30, 0, settings.steps)
    val crossing   = PredictedTrack.straight(PlaneReading(12, -12, 0, 5), settings.steps, settings.dtS)
    val situation  = Situation(
      PredictedVehicle(ReducedModel.lag(0.95, 1, 0), PlaneReading(0, 0, 5, 0)),
      0,
      0.1,
      Vector(Behaviour(Target.Along(goal))),
      Vector(crossing, PredictedTrack.standing(9, -3.5, settings.steps))
    )
    val plan  = improved(planner, situation, 10)
    val flown = ManoeuvreRollout(situation, objective, settings.dtS).fly(plan.manoeuvre)
    assertEquals(flown.breaches, Vector.empty)
    val straight = ManoeuvreRollout(situation, objective, settings.dtS).fly(planner.start.manoeuvre)
    assert(straight.breaches.nonEmpty, "straight on it would collide")
    for step <- 0 until settings.steps do
      val limit = objective.limits.turnRateAt(plan.manoeuvre.speeds(step))
      assert(plan.manoeuvre.turnRates(step).abs <= limit * (1 + 1e-6))

  test("a plan turns back before the geofence"):
    val fenced    = objective.copy(geofences = Vector(Geofence(Fence.rectangle(-50, 20, -50, 50))))
    val settings  = PlannerSettings(steps = 40)
    val planner   = Planner(settings, fenced)
    val outside   = PredictedTrack.standing(60, 0, settings.steps)
    val situation =
      pursuit.copy(behaviours = Vector(Behaviour(Target.Along(outside))), own = vehicle(0, 0, 4, 0))
    val plan = improved(planner, situation, 10)
    assertEquals(ManoeuvreRollout(situation, fenced, settings.dtS).fly(plan.manoeuvre).breaches, Vector.empty)

  test("a limit is broken by what it lacks itself; the margin of plans only has a cost"):
    val limits    = CommandLimits(0, 10, 1, 0)
    val kept      = Geofence(Fence.rectangle(-50, 30, -50, 50), marginM = 1)
    val objective = PlanCost(
      limits,
      separation = SeparationCost(3, margin = 0, growth = 0, price = 0, doubt = 1),
      geofences = Vector(kept)
    )
    // One step north; the vehicle ends at the position that `northM` says.
    def flown(northM: Double, otherM: Double) =
      val own  = PredictedVehicle(ReducedModel.lag(1, 1e-6, 0), PlaneReading(northM, 0, 0, 0))
      val seen =
        Situation(own, 0, 0.1, Vector.empty, Vector(PredictedTrack.standing(northM, otherM, steps = 1)))
      ManoeuvreRollout(seen, objective, 0.1).fly(Manoeuvre.straight(0, 1))
    assertEquals(flown(0, 2.6).breaches, Vector.empty)
    assert(flown(0, 2.6).cost > PlanCost.Breach)
    assertEquals(flown(29.5, 9).breaches, Vector.empty)
    assert(flown(29.5, 9).cost > PlanCost.Breach)
    assertEquals(flown(0, 9).cost, 0.0)
    assertEquals(
      (flown(0, 1.6).breaches ++ flown(30.5, 9).breaches).map(_.text),
      Vector(
        "0.40 m nearer to another vehicle than the separation, 0.1 s ahead",
        "0.50 m outside of the geofence, 0.1 s ahead"
      )
    )

  test("without the vector module the scalar block simulates equal candidates"):
    val settings = PlannerSettings(blocksPerSlice = 2)
    val scalar   = new Planner(settings, objective, ScalarBlock(settings.steps))
    val lanes    = new Planner(settings, objective, PlanKernel(settings.steps))
    assertEqualsDouble(improved(scalar, pursuit, 3).cost, improved(lanes, pursuit, 3).cost, 1e-3)

  test("a suggested manoeuvre is among the candidates, and is found if it is the best"):
    val planner = Planner(PlannerSettings(), objective)
    val good    = improved(planner, pursuit, 20, stream = 5).manoeuvre
    val told    = improved(planner, pursuit.copy(suggested = Vector(good)), 1)
    assert(told.cost <= costs(good, pursuit, planner) + 1e-3)
    assert(told.cost < improved(planner, pursuit, 1).cost)

  test("a manoeuvre shifted by a part of a step is interpolated"):
    val manoeuvre = Manoeuvre(IArray(0f, 1f, 2f), IArray(5f, 5f, 5f))
    assertEquals(manoeuvre.shifted(0.05, 0.1).turnRates.toSeq, Seq(0.5f, 1.5f, 2f))
    assertEquals(manoeuvre.shifted(0.1, 0.1).turnRates.toSeq, Seq(1f, 2f, 2f))
    assertEquals(manoeuvre.shifted(7, 0.1).turnRates.toSeq, Seq(2f, 2f, 2f))
