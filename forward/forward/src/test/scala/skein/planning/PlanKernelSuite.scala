package skein.planning

import skein.formula.ErrorBound
import skein.lanes.{Bicycle, LanePolicies, PairAgreement, Rolling, UnseenPolicySuite}
import skein.lanes.policy.PolicyLanes
import skein.policy.{PaperEvader, Policy}
import skein.scenario.Fence
import skein.signal.SplitMix64
import skein.vehicle.{PlaneReading, Plant, PlantFlight, ReducedModel}

class PlanKernelSuite extends munit.FunSuite:
  private val size                = CandidateBlock.Size
  private val (steps, dtS, knots) = (24, 0.1, 3)

  private val evader = opponent(PaperEvader())
  private val track  = new Target.Along(PredictedTrack.turning(PlaneReading(3, -5, 4, 1), 0.4, steps, dtS))
  private def vehicle(at: PlaneReading) = PredictedVehicle(ReducedModel.AirSim, at)

  private def opponent(policy: Policy): Target.Opponent =
    new Target.Opponent(vehicle(PlaneReading(9, 4, -2, 3)), 5, 2.1, policy)

  private val objective = PlanCost(
    CommandLimits(4, 10, 1.25, 6),
    closest = 0.7,
    capture = 3,
    captureRadius = 4,
    turning = 0.004,
    speedChange = 0.05,
    cruiseSpeed = 8
  )
  private val search = SamplingDistribution(
    IArray.tabulate(steps)(0.02f * _),
    IArray.tabulate(steps)(step => 0.5f + 0.01f * step),
    IArray.fill(steps)(8f),
    IArray.fill(steps)(2f)
  )

  private def situation(behaviours: Behaviour*): Situation =
    Situation(vehicle(PlaneReading(1, 2, 6, 1)), 0.4, 0.13, behaviours.toVector)

  private val others = Vector(
    PredictedTrack.straight(PlaneReading(6, 5, -1, 0.5), steps, dtS),
    PredictedTrack.straight(PlaneReading(-3, 2, 3, 0), steps, dtS)
  )

  private def flown(block: CandidateBlock, situation: Situation, objective: PlanCost): CandidateBlock =
    val keys = SplitMix64(5)
    block.situate(situation, objective, dtS)
    block.draw(Array.fill(size)(keys.nextLong().toInt), search, objective.limits, knots)
    block.fly()
    block

  /** Costs are equal except at jumps, within the accumulated rounding of floats. */
  private def assertAgree(situation: Situation, objective: PlanCost)(using munit.Location): Unit =
    val kernel = flown(PlanKernel(steps), situation, objective)
    val scalar = flown(ScalarBlock(steps), situation, objective)
    assertEquals(kernel.turnRates.toSeq, scalar.turnRates.toSeq)
    assertEquals(kernel.speeds.toSeq, scalar.speeds.toSeq)
    for i <- 0 until size do
      val (off, most) = ((kernel.costs(i) - scalar.costs(i)).abs, 2e-5 * (1 + scalar.costs(i).abs))
      if off >= most then
        val near = jumps(situation, objective, manoeuvre(kernel, i))
        assert(
          off <= most + near.map(_.by).sum,
          s"candidate $i costs ${kernel.costs(i)} by lanes and ${scalar.costs(i)} in doubles; jumps: $near"
        )

  private def manoeuvre(block: CandidateBlock, i: Int) = Manoeuvre(
    IArray.tabulate(steps)(step => block.turnRates(step * size + i)),
    IArray.tabulate(steps)(step => block.speeds(step * size + i))
  )

  /** A discontinuity of the cost.
    *
    * @param nearM the distance from it
    * @param by the size of the largest jump
    */
  private case class Jump(what: String, nearM: Double, by: Double)

  /** Accumulated rounding of floats over a horizon, m: 24 steps of three roundings each, at some 30 m. */
  private val off = 1e-4

  private def jumps(situation: Situation, objective: PlanCost, manoeuvre: Manoeuvre): Seq[Jump] =
    def fly(objective: PlanCost) = ManoeuvreRollout(situation, objective, dtS).fly(manoeuvre)
    val track                    = fly(objective).track
    val breach                   = PlanCost.Breach * (1 + 2 * off)
    val limits                   =
      for
        step         <- 0 until steps
        (what, near) <-
          objective.geofences.map: geofence =>
            ("a fence", geofence.beyond(track.x(step), track.y(step)) + PlanCost.Guard)
          ++ situation.others.map: other =>
            val distance = math.hypot(track.x(step) - other.x(step), track.y(step) - other.y(step))
            ("another vehicle", objective.separation.minimum + PlanCost.Guard - distance)
        if near.abs < off
      yield Jump(s"$what, step $step", near, breach)
    val captured =
      fly(objective.copy(captureRadius = objective.captureRadius - off)).cost -
        fly(objective.copy(captureRadius = objective.captureRadius + off)).cost
    limits ++ Option.when(captured > 0)(Jump("a capture", off, captured)) ++
      situation.behaviours.flatMap(decisions(situation, objective, manoeuvre, _))

  /** Discontinuities of the opponent's own decision: after one, the flight differs. */
  private def decisions(
      situation: Situation,
      objective: PlanCost,
      manoeuvre: Manoeuvre,
      behaviour: Behaviour
  ): Seq[Jump] = behaviour.target match
    case opponent: Target.Opponent =>
      val log   = PairAgreement.Log(opponent.policy)
      val alone = situation.copy(behaviours = Vector(Behaviour(opponent.copy(policy = log))))
      ManoeuvreRollout(alone, objective, dtS).fly(manoeuvre): Unit
      val form  = PolicyLanes.get(opponent.policy)
      val nodes = form.outputs
      for
        (seen, step) <- log.seen.zipWithIndex.toSeq
        inputs = LanePolicies.inputsOf(seen, log.before(step))
        bound  = ErrorBound.of(nodes, inputs, inputs.map(_ => off), form.parametersOf(opponent.policy))
        (node, near) <- bound.undecided(nodes)
      yield Jump(s"step $step, $node", near, Double.PositiveInfinity)
    case _ => Nil

  test("kernel and scalar reference agree on a pursuit of the paper's evader"):
    assertAgree(situation(Behaviour(evader)), objective)

  for (name, draw) <- UnseenPolicySuite.Unseen do
    test(s"kernel and scalar reference agree on a pursuit of an opponent by a policy never seen: $name"):
      assertAgree(situation(Behaviour(opponent(draw(SplitMix64(3))))), objective)

  test(
    "kernel and scalar reference agree on a vehicle, and on an opponent, with a plant that is new to them"
  ):
    val bicycle = PredictedVehicle(Bicycle(1.2, 0.3, 4, 0.4), Rolling(3, -2, 0.4, 5, 0.1), 100, -50, 0.5)
    assertAgree(situation(Behaviour(track)).copy(own = bicycle), objective)
    assertAgree(situation(Behaviour(evader.copy(vehicle = bicycle.moved(-104, 55)))), objective)

  test("kernel and scalar reference agree on models that turn slower than they speed up, and on short lags"):
    for model <- Seq(ReducedModel(0.9, 0.8, 0, 1.4, 0.02), ReducedModel.lag(1, 0.05, 0)) do
      val moving = PredictedVehicle(model, PlaneReading(1, 2, 6, 1))
      assertAgree(situation(Behaviour(track)).copy(own = moving), objective)
      assertAgree(situation(Behaviour(evader.copy(vehicle = moving.moved(8, 2)))), objective)

  test("kernel and scalar reference agree where a plant's steps are shorter than the plan's"):
    for stepS <- Seq(0.1, 0.05, 0.04) do
      val moving = PredictedVehicle(Sliding(stepS), PlaneReading(0, 0, 6, 1), 1, 2, 0.5)
      assertAgree(situation(Behaviour(track)).copy(own = moving), objective)
      assertAgree(situation(Behaviour(evader.copy(vehicle = moving.moved(8, 2)))), objective)

  test("a step longer than the plant's is simulated in pieces"):
    val own    = vehicle(PlaneReading(1, 2, 6, 1))
    val halves = own.flown(3, 4, 0.1).flown(3, 4, 0.1)
    assertEquals(own.flown(3, 4, 0.2).motion, halves.motion)

  test("kernel and scalar reference agree on following a track"):
    assertAgree(situation(Behaviour(track)), objective)

  test("kernel and scalar reference agree on distances that soften when they are short"):
    assertAgree(situation(Behaviour(track)), objective.copy(capture = 0, softness = 2))

  test("kernel and scalar reference agree on several behaviours, each by its weight"):
    val closer = evader.copy(vehicle = vehicle(PlaneReading(4, 3, 1, 1)))
    assertAgree(situation(Behaviour(evader, 0.5), Behaviour(track, 0.3), Behaviour(closer, 0.2)), objective)

  test("kernel and scalar reference agree on the costs of coming near others and of leaving the geofence"):
    val narrow =
      objective.copy(
        separation = SeparationCost(minimum = 1.5, margin = 2),
        geofences = Vector(Geofence(Fence.rectangle(-20, 16, -6, 12)))
      )
    val busy   = situation(Behaviour(track)).copy(others = others)
    val scalar = flown(ScalarBlock(steps), busy, narrow)
    assert(scalar.costs.count(_ > 1000) > 10, "some candidates should breach a limit")
    assert(scalar.costs.count(_ < 1000) > 10, "some candidates should not")
    assertAgree(busy, narrow)

  test("kernel and scalar reference agree on fences of any shape"):
    val corner =
      Vector((-20.0, -20.0), (16.5, -20.0), (16.5, 8.5), (13.0, 8.5), (13.0, 10.5), (-20.0, 10.5))
    for fence <- Seq(Fence.Polygon(corner), Fence.Circle(1, 2, 15.6)) do
      val fenced = objective.copy(geofences = Vector(Geofence(fence, marginM = 0.5)))
      val scalar = flown(ScalarBlock(steps), situation(Behaviour(track)), fenced)
      assert(scalar.costs.count(_ > 1000) > 10 && scalar.costs.count(_ < 1000) > 10, s"$fence")
      assertAgree(situation(Behaviour(track)), fenced)

  test("a candidate that the kernel finds within the hard limits is within them in doubles"):
    val narrow =
      objective.copy(
        separation = SeparationCost(minimum = 1.5, margin = 0),
        geofences = Vector(Geofence(Fence.rectangle(-20, 16, -6, 12)))
      )
    val busy   = situation(Behaviour(track)).copy(others = others)
    val kernel = flown(PlanKernel(steps), busy, narrow)
    val check  = ManoeuvreRollout(busy, narrow, dtS)
    for i <- 0 until size if kernel.costs(i) < 900 do
      assertEquals(check.fly(manoeuvre(kernel, i)).breaches, Vector.empty)

  test("drawn candidates are within the limits, differ, and use the whole of them"):
    val block = flown(PlanKernel(steps), situation(Behaviour(evader)), objective)
    for at <- block.turnRates.indices do
      val speed = block.speeds(at)
      assert(speed >= 4 && speed <= 10, s"speed $speed")
      assert(block.turnRates(at).abs <= objective.limits.turnRateAt(speed) * (1 + 1e-6), s"turns at $at")
    assert(block.turnRates.distinct.length > size * steps / knots / 2)
    assert(block.turnRates.max > 0.9 && block.turnRates.min < -0.9)

  test("a manoeuvre is simulated as by the reduced model"):
    val model     = ReducedModel.AirSim
    val manoeuvre = Manoeuvre(IArray.tabulate(steps)(0.05f * _), IArray.tabulate(steps)(4 + 0.2f * _))
    val flown     = ManoeuvreRollout(situation(Behaviour(track)), objective, dtS).fly(manoeuvre).track
    val flight    = PlantFlight(model)
    flight.start(0, PlaneReading(1, 2, 6, 1))
    var heading = 0.4
    for step <- 0 until steps do
      heading += manoeuvre.turnRates(step) * (if step == 0 then 0.13 else dtS)
      val speed = manoeuvre.speeds(step)
      flight.act(step * dtS, speed * math.cos(heading), speed * math.sin(heading))
      flight.advance((step + 1) * dtS)
      assertEqualsDouble(flown.x(step), flight.reading.northM, 1e-9)
      assertEqualsDouble(flown.y(step), flight.reading.eastM, 1e-9)

  test("normal draws have mean 0 and variance 1"):
    val drawn = (1 to 20000).map(Draws.normal(7, _).toDouble)
    val mean  = drawn.sum / drawn.size
    assertEqualsDouble(mean, 0, 0.03)
    assertEqualsDouble(drawn.map(value => (value - mean) * (value - mean)).sum / drawn.size, 1, 0.03)

/** A plant whose state is its reading. */
private final case class Sliding(stepS: Double) extends Plant[PlaneReading]:
  def initial: PlaneReading                   = PlaneReading(0, 0, 0, 0)
  def read(state: PlaneReading): PlaneReading = state

  def step(from: PlaneReading, northMps: Double, eastMps: Double, dtS: Double): PlaneReading =
    val share    = dtS / (0.4 + dtS)
    val (vx, vy) =
      (from.northMps + share * (northMps - from.northMps), from.eastMps + share * (eastMps - from.eastMps))
    PlaneReading(from.northM + vx * dtS, from.eastM + vy * dtS, vx, vy)
