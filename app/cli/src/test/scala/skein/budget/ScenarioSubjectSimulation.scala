package skein.budget

import skein.optimise.Objective
import skein.scenario.*
import skein.search.Conditions
import skein.signal.LatencyDistribution
import skein.testing.Optimised
import skein.units.*
import skein.vehicle.VehicleKind

class ScenarioSubjectSimulation extends munit.FunSuite, Optimised:
  private given Scenarios = Scenarios.ours
  private val surround    = Surround(vehicles = 4)

  private def question(scenario: Scenario, objective: Option[String], conditions: Conditions, threads: Int) =
    ScenarioQuestion.of(scenario, objective, conditions, seed = 1, threads)

  private def subject(
      scenario: Scenario,
      objective: Option[String] = None,
      conditions: Conditions = Conditions("stream", "drag", 100, 20),
      threads: Int = 2
  ): BudgetSubject =
    question(scenario, objective, conditions, threads).flatMap(_.subject(plantIsTold =
      false
    )).fold(fail(_), identity)

  private def at(of: BudgetSubject, roundTripMs: Double) = of
    .tallies(BudgetCells(Vector(LatencyDistribution.Constant(Span.ofMillis(roundTripMs))), 2))
    .fold(fail(_), _.head.mean)

  test("a measure of a quantity equals that computed from the whole flight's tracks"):
    val plain = subject(surround)
    assert(plain.engine(Vector(LatencyDistribution.Vpn)).text.startsWith("SIMD, "))
    assertEquals((plain.task.formula, plain.task.unit), ("off-ring", "m"))
    val both   = subject(Whole(), Some("off-ring + 0*lasts"))
    val scalar = both.engine(Vector.empty).text
    assertEquals(
      scalar,
      "scalar: lasts is of whole flights: expected a reduction of a quantity of positions and time"
    )
    for latencyMs <- Seq(0.0, 200.0) do
      // Tracks are evaluated every 20 ms, on lines between the positions of each period; a quantity once a
      // period.
      assertEqualsDouble(at(plain, latencyMs), at(both, latencyMs), 0.1 * at(plain, latencyMs))

  test("cars alone, without an altitude, are judged"):
    assert(at(subject(Cars()), 50) > 0)

  test("without latency the result equals the paused flight's, and more latency deviates further"):
    val plain = subject(surround)
    val truth = plain.truth(1).fold(fail(_), identity)
    val off   = Seq(0.0, 200.0, 400.0).map(at(plain, _) - truth).map(_.abs)
    assert(off(0) < 0.02 * truth && off(1) > off(0) && off(2) > off(1), s"$off off $truth")

  test("where readings have errors, the truth is the mean over the cells' episodes"):
    def truths(objective: Option[String]) =
      val conditions = Conditions("stream", "drag", 100, 20, sensors = Some("position=5"))
      val noisy      = subject(Whole(), objective, conditions)
      for episodes <- Vector(1, 2, 4) yield noisy.truth(episodes).fold(fail(_), identity)
    for objective <- Seq(None, Some("off-ring + 0*lasts")) do
      assertEquals(clue(truths(objective)).distinct.size, 3)
    val calm = subject(surround)
    assertEquals(calm.truth(4), calm.truth(1))

  test("any measure can be used: crossing vehicles reach their goals later over a slow link"):
    val crossing = subject(Crossing(vehicles = 4), Some("to-goal"))
    val truth    = crossing.truth(1).fold(fail(_), identity)
    assertEqualsDouble(at(crossing, 0), truth, 0.1)
    assert(at(crossing, 400) > truth + 0.1, s"$truth")

  test("a policy in three dimensions is simulated in space, for any measure"):
    val drifting = subject(Drift(), conditions = Conditions("stream", "drag", 100, 10))
    assert(drifting.engine(Vector.empty).text.startsWith("scalar: furthest is of whole flights"))
    val truth = drifting.truth(1).fold(fail(_), identity)
    assert(at(drifting, 400) > truth, s"$truth")

  test("a measure that a flight never reaches deviates more than any other"):
    val never = subject(Drift(toM = 1000), Some("arrives"), Conditions("stream", "drag", 100, 10))
    assertEquals(at(never, 0), Objective.Never)
    val swept = BudgetSweep(never, BudgetAxes(Vector(0), Vector(0)), Tolerance.Within(1), Some(1))
    assert(clue(swept.map(
      _ => (),
      () => false
    )).left.exists(_.contains("has no value in the paused truth")))

  test("if the paused loop's value is 0, deviations are distances, not fractions"):
    assert(Tolerance.Share(0.05).per(0).left.exists(_.contains("--within")))
    assertEquals(Tolerance.Within(2).per(0), Right(1.0))
    assertEquals((Tolerance.Within(2).text("m"), Tolerance.Share(0.05).text("m")), ("2 m", "5 %"))

  test("a scenario that cannot be swept is refused in one line"):
    assertEquals(
      question(surround, Some("speed"), Conditions("stream", "drag", 100, 20), 1).map(_.objective.formula),
      Left(
        "--objective: objective 'speed', at character 1: expected one of " +
          "off-ring, ring, nearest, gap, surrounded-after, got 'speed'"
      )
    )
    assert(
      question(Drift(), None, Conditions("stream", "drag", 100, 20), 1)
        .flatMap(_.subject(plantIsTold = true))
        .left
        .exists(_.startsWith("--plant: expected tilt or quadrotor, got drag: "))
    )

/** [[Surround]] with a measure of whole flights. */
final case class Whole() extends Scenario:
  private def around                     = Surround(vehicles = 4)
  def agents: Vector[skein.policy.Agent] = around.agents
  override def measures: Vector[Measure] =
    around.measures :+ Measure("lasts", "s")(tracks => Some(tracks.lastS))

/** The two cars of [[Convoy]], alone. */
final case class Cars(gapM: Double = 12) extends Scenario:
  def agents: Vector[skein.policy.Agent] = Convoy(gapM).agents.filter(_.kind == VehicleKind.Car)
  override def measures: Vector[Measure] = Vector(Series.of("gap", "m", Gap).mean("gap"))

case object Gap extends Quantity:
  def of(positions: Positions): Double = positions.distanceM(0, 1)

/** Flies north until it is far enough, climbing: late commands overshoot. */
final case class Drift(toM: Double = 12) extends Scenario:
  import skein.policy.*
  def agents: Vector[Agent] =
    Vector(Agent("Lone", Role("Lone"), MetresPerSecond(6), Vector3(0, 0, -10), Radians(0), Northward(toM)))

  private val north = Series("north", "m")(tracks => instant => tracks.northM(0)(instant))

  override def measures: Vector[Measure] =
    Vector(north.most("furthest"), north.firstAbove("arrives", toM))

final case class Northward(toM: Double) extends skein.policy.Policy:
  import skein.policy.*
  type Memory = Unit
  def start: Unit                                             = ()
  def choose(seen: Observation, memory: Unit): (Action, Unit) =
    val north = if seen.own.kinematics.positionNed.x < toM then 6.0 else 0.0
    (Action.Velocity(Vector3(north, 0, -0.5)), ())
