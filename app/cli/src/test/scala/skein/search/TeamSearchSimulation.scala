package skein.search

import com.typesafe.config.ConfigFactory
import skein.budget.Cars
import skein.optimise.{Evaluator, ScenarioTerm, Search, SearchState}
import skein.scenario.*
import skein.settings.ScenarioSettings
import skein.testing.Optimised

class TeamSearchSimulation extends munit.FunSuite, Optimised:
  private given Scenarios = Scenarios.ours

  private val question = TeamQuestion(
    scenario = "surround",
    set = Map("vehicles" -> "4"),
    vary = Vector(Varied("ring-m", 4, 12), Varied("pursuer-mps", 5, 12)),
    objective = "off-ring + 0.05*gap",
    method = "random",
    conditions = Conditions("stream", "drag", 100, 12),
    link = "vpn",
    candidates = 12,
    episodes = 2,
    population = 4,
    seed = 3,
    fresh = 4
  )

  private def setup(of: TeamQuestion = question) = of.setup.fold(fail(_), identity)

  private def ended(search: Search, evaluator: Evaluator): SearchState =
    Iterator.iterate(search.start)(search.step(_, evaluator, Int.MaxValue)).find(_.isDone).get

  test("the best settings of a scenario are found with SIMD, and fly accepts the written file"):
    val ready = setup()
    assert(ready.engines.startsWith("SIMD"), ready.engines)
    val judges = ready.judges(2)
    val found  = SearchResult.measured(ready, judges, ended(ready.search, judges(Judge.Candidates)), 4).get
    assert(found.fresh.mean < found.baseline.mean, SearchResult(ready, found).summary)
    val written =
      ConfigFactory.parseString(ready.file(found)._2).withFallback(ConfigFactory.load()).resolve()
    val flown = ScenarioSettings.read(written).fold(fail(_), identity)
    assertEquals(flown, ready.scenario(found.best))

  test("a candidate's value equals its measures of that flight by the scalar engine"):
    val ready    = setup()
    val lanes    = ready.judges(1)(Judge.Candidates).tallies(Vector(Vector(8.0, 8.0)), 0 until 3).head
    val surround = ready.scenario(Vector(8.0, 8.0))
    val measures = surround.measures.filter(measure => Set("off ring", "gap")(measure.name))
    assertEquals(measures.map(_.reduced.nonEmpty), Vector(true, true))
    val paths = (0 until 3).map(episode => TeamSearchSimulation.flown(surround, ready, episode))
    val means = measures.map(measure =>
      paths.map(places =>
        val OverFlight(quantity, reduction, _) = measure.reduced.get
        reduction.of(places.map(quantity.of), _ * 0.1, 0.1)
      ).sum / 3
    )
    assertEqualsDouble(lanes.mean, means(0) + 0.05 * means(1), 2e-3)

  test("the scenario is compared unchanged, also if its setting lies outside of the searched bounds"):
    def baseline(least: Double) =
      val ready = setup(question.copy(vary = Vector(Varied("ring-m", least, 20)), objective = "off-ring"))
      val own   = ready.baseline.candidate
      (ready.baseline.label, own, ready.judges(1)(Judge.Baseline).tallies(Vector(own), 0 until 2))
    assertEquals(baseline(10), baseline(4))
    assertEquals(baseline(10)._2, Vector(Surround().ringM))

  test("settings of cars alone are searched, without an altitude"):
    given Scenarios = Scenarios(ScenarioKind(Cars()))
    val ready       =
      question
        .copy("cars", Map.empty, Vector(Varied("gap-m", 8, 16)), "gap", "grid", candidates = 4)
        .setup
        .fold(fail(_), identity)
    val gaps = ready.judges(1)(Judge.Candidates).tallies(Vector(Vector(8.0), Vector(16.0)), 0 until 2)
    assert(clue(gaps(0).mean) < clue(gaps(1).mean))

  test("a measure of whole flights is searched world by world, and the engine's line states that"):
    given Scenarios = Scenarios(ScenarioKind(TeamSearchSimulation.Lined()))
    val vary        = Vector(Varied("lane-m", 2, 10), Varied("spacing-m", 4, 12))
    val ready       =
      question.copy("lined", Map.empty, vary, "arrived", candidates = 4, episodes = 1).setup.fold(
        fail(_),
        identity
      )
    assert(ready.engines.matches("scalar: arrived is of whole flights.*"), ready.engines)
    assert(ready.rate(1).exists(_.matches("about [0-9,]+ a second")), ready.rate(1))
    assert(!ready.isVirtual && !ready.engine(ready.space.defaults, Judge.Candidates).fliesByLanes)
    val judges = ready.judges(2)(Judge.Candidates)
    val one    = judges.tallies(Vector(Vector(8.0, 8.0), Vector(4.0, 8.0)), 0 until 2)
    assertEquals(
      one,
      ready.judges(1)(Judge.Candidates).tallies(Vector(Vector(8.0, 8.0), Vector(4.0, 8.0)), 0 until 2)
    )
    assertEquals(judges.valuesUnless(() => true)(Vector(Vector(8.0, 8.0)), 0 until 2), None)

  test("off-ring measured in whole flights of the scalar engine equals the SIMD result"):
    val reduced = setup()
    val whole   = reduced.flownBy match
      case TeamEngine.Reduced(conditions, delays) =>
        TeamEngine.Whole(WholeFlights.scalar(
          conditions,
          delays,
          question.seed,
          "the reference was asked for"
        ))
      case other => fail(other.toString)
    def mean(of: ReadySearch) =
      of.judges(1)(Judge.Candidates).tallies(Vector(Vector(8.0, 8.0)), 0 until 2).head.mean
    // The window's first and last instants differ by up to half a period, in which a vehicle flies 0.4 m.
    assertEqualsDouble(mean(reduced.copy(flownBy = whole)), mean(reduced), 0.1)

  test("settings that change the altitude are simulated in space, and models of level flight are refused"):
    val high  = question.copy(vary = Vector(Varied("altitude-m", 10, 20)), objective = "off-ring")
    val ready = setup(high)
    assertEquals(ready.model, "tilt")
    assert(ready.engines.startsWith("SIMD, "), ready.engines)
    val plant =
      high.copy(conditions = high.conditions.copy(plant = "reduced")).setup.swap.getOrElse("it was taken")
    assert(plant.startsWith("--plant: expected tilt or quadrotor, got reduced: "), plant)
    // Even if it is the default plant.
    assert(clue(high.read(plantIsTold =
      true
    )).left.exists(_.startsWith("--plant: expected tilt or quadrotor")))
    // A candidate at its own altitude has equal results with SIMD and by the scalar engine.
    def values(judge: Judge) = ready.judges(1)(judge).tallies(Vector(Vector(12.0), Vector(17.0)), 0 until 2)
    val reference            = ready.reference(Vector(17.0), 0 until 2).get
    assertEqualsDouble(values(Judge.Winner)(1).mean, reference.mean, 0.02)

  test("a search over settings is stored, read back and continued to an equal end"):
    val ready     = setup(question.copy(method = "cma-es"))
    val evaluator = ready.judges(2)(Judge.Candidates)
    val broken    = Iterator
      .iterate(ready.search.start): state =>
        val text = SearchFile.json(SearchFile(SearchFile.Version, ready.question, state))
        val read = SearchFile.parse(text).fold(fail(_), identity)
        assertEquals(read.question, ready.question)
        ready.search.step(read.state, evaluator, 3)
      .find(_.isDone)
      .get
    assertEquals(broken, ended(ready.search, evaluator))

  test("an impossible search is refused with one line that names the option"):
    def mistake(of: TeamQuestion) = of.setup.fold(identity, _ => fail("it was taken"))
    assertEquals(
      mistake(question.copy(vary = Vector(Varied("ring", 4, 12)))),
      "--vary: the scenario surround has no setting 'ring'; the nearest is 'ring-m'"
    )
    assertEquals(
      mistake(question.copy(vary = Vector(Varied("vehicles", 4, 12)))),
      "--vary: expected a setting that measures something, got 'vehicles', which counts or chooses"
    )
    assertEquals(
      mistake(question.copy(vary = Vector(Varied("ring-m", -1, 12)))),
      "--vary: ring-m: expected more than 0, got -1.0"
    )
    assertEquals(
      mistake(question.copy(objective = "surrounded")),
      "--objective: objective 'surrounded', at character 1: expected one of " +
        s"${Surround().measures.map(ScenarioTerm.keyOf).mkString(", ")}, got 'surrounded'"
    )
    assertEquals(
      Varied.parse("ring-m=12..4"),
      Left(
        "expected a setting and its bounds, the lower one first, " +
          "for example ring-m=4..12, got 'ring-m=12..4'"
      )
    )
    assertEquals(Varied.parse("ring-m=-1e-1..1.2E+1"), Right(Varied("ring-m", -0.1, 12)))
    for text <- Seq("ring-m=4..1e308", "ring-m=4..1e999", "ring-m=-2000000000..4") do
      assertEquals(Varied.parse(text), Left(s"expected bounds from -1e9 to 1e9, got '$text'"))

object TeamSearchSimulation:
  /** A crossing with a measure that is computed from whole tracks. */
  final case class Lined(laneM: Double = 4, spacingM: Double = 6) extends Scenario:
    def agents                             = Crossing(8, laneM = laneM, spacingM = spacingM).agents
    override def measures: Vector[Measure] =
      Vector(Measure.count("arrived")(tracks => tracks.vehicles.count(tracks.northM(_).last > 20)))

  import skein.forward.{Engagement, LoopObserver, Rollout}
  import skein.simd.WorldRandom

  /** Positions of all vehicles in the last 10 s of an episode, simulated by the scalar engine. */
  private def flown(scenario: Scenario, setup: ReadySearch, episode: Int): Vector[Positions] =
    val (conditions, delays) = setup.flownBy match
      case TeamEngine.Reduced(conditions, delays) => (conditions, delays)
      case other: TeamEngine.Whole                => throw AssertionError(other.toString)
    val engagement = Engagement.of(scenario.fleet, setup.durationS)
    val count      = engagement.agents.size
    val seen       = Vector.newBuilder[(Double, Double, Double)]
    Rollout(engagement, conditions.timing, delays, conditions.vehicle.response).fly(
      WorldRandom.key(setup.seed, 0, episode),
      observer = new LoopObserver:
        override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
          seen += ((timeS, x, y))
    ): Unit
    seen
      .result()
      .grouped(count)
      .toVector
      .takeRight(101)
      .map(all =>
        Positions(
          IArray.from(all.map(_._2)),
          IArray.from(all.map(_._3)),
          IArray.fill(count)(-5.0),
          Double.NaN
        )
      )
