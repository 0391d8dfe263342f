package skein.budget

import skein.lanes.Engine
import skein.scenario.Scenarios
import skein.optimise.{LatencyBudget, RunningStats}
import skein.plot.Mark
import skein.policy.{PolicyFamily, Role}
import skein.optimise.LatencyBudget.Bound
import skein.search.Conditions
import skein.settings.PolicyFile
import skein.signal.LatencyDistribution
import skein.testing.Optimised
import skein.units.Span

class BudgetSuite extends munit.FunSuite, Optimised:
  private given Scenarios = Scenarios.ours
  private val paper       = PolicyFile.ofDefaults(Role.Pursuer, PolicyFamily.paperPursuer)

  private val axes = BudgetAxes.of(200, 5, 60, 3)

  private def sweep(loop: String, episodes: Int, threads: Int = 2, durationS: Double = 60) =
    val question = BudgetQuestion.OfDuel(
      "pursuer",
      paper.text,
      PolicyFile.paperOf(Role.Evader).text,
      "last10s",
      Conditions(loop, "reduced", 100, durationS),
      seed = 1
    )
    BudgetSweep(
      question.subject(threads).fold(fail(_), identity),
      axes,
      Tolerance.Share(0.05),
      Some(episodes)
    )

  private def map(of: BudgetSweep): LatencyBudget = of.map(_ => (), () => false).fold(fail(_), identity)

  test("without latency the map shows the paused value, and more latency is worse for the paper's pursuer"):
    val budget = map(sweep("stream", 16))
    assertEqualsDouble(budget.deviation(0, 0).get, 0, 2e-3)
    val off = budget.meansMs.indices.map(budget.deviation(0, _).get)
    assertEquals(off.sorted, off)
    assert(off.last > 0.1, off)
    assertEquals(budget.cells.map(_.map(_.isDefined)).map(_.head), Vector(true, false, false))

  test("the map does not depend on the number of threads"):
    assertEquals(map(sweep("stream", 5, threads = 1)), map(sweep("stream", 5, threads = 3)))

  test("a loop without a SIMD kernel has a map, too, and progress counts its episodes"):
    var done   = 0L
    val flying = sweep("sequential", 2, durationS = 12)
    assert(flying.map(count => done = count, () => false).isRight)
    assertEquals(done, flying.expected)

  test("a cancelled map has the rows simulated until then, and without any there is no map"):
    assertEquals(sweep("stream", 5).map(_ => (), () => true), Left(BudgetSubject.Stopped))
    val whole       = map(sweep("stream", 5))
    val ofTwoRows   = 5L * whole.cells.take(2).flatten.flatten.size
    var isCancelled = false
    val cut         = sweep("stream", 5).map(done => isCancelled = done >= ofTwoRows, () => isCancelled)
    assertEquals(cut, Right(whole.copy(jittersMs = whole.jittersMs.take(2), cells = whole.cells.take(2))))

  private def shown(bound: Vector[Double], legs: Legs = Legs.RoundTrip) = BudgetMap(
    BudgetTask("stream", 100, 60, "ideal", "paper-pursuer", "last10s", "m"),
    Engine(Engine.Kind.Lanes, "SIMD"),
    Tolerance.Share(0.05),
    1,
    LatencyBudget(
      Vector(0.0, 50.0, 100.0),
      Vector(0.0, 20.0),
      Vector.fill(2)(bound.map(value => Some(skein.optimise.RunningStats(1, value, 0)))),
      truth = 8,
      per = 8
    ),
    Vector.empty,
    legs
  )

  test("one sentence states the greatest tolerated latency"):
    val leaves = shown(Vector(8, 8.2, 8.6))
    leaves.budget.holdsUpTo(1, 0.05) match
      case Bound.At(meanMs) => assertEqualsDouble(meanMs, 75, 1e-9)
      case other            => fail(s"$other")
    assertEquals(
      leaves.sentence(18),
      "holds within 5 % of the truth, 8 m, up to 75 ms mean at " +
        "20 ms jitter (round trips; stream every 100 ms)"
    )
    assertEquals(
      leaves.copy(legs = Legs.OneWay).sentence(18),
      "holds within 5 % of the truth, 8 m, up to 38 ms mean at 10 ms jitter (one way; stream every 100 ms)"
    )
    assert(shown(Vector(8, 8, 8)).sentence(0).contains("as far as the map goes, 100 ms mean"))
    assert(shown(Vector(9, 9, 9)).sentence(0).contains("does not hold"))

  test("cells are written as CSV and JSON in the user's terms"):
    val map = shown(Vector(8, 8.2, 8.6), Legs.OneWay)
    assertEquals(map.csvRows.size, 6)
    assert(map.csvRows(1).startsWith("100.0,25.0,0.0,8.2,0.0,1,0.0249999"), map.csvRows(1))
    val json = ujson.read(BudgetMap.json(Vector(map), 20))(0)
    assertEquals(json("engine").str, "SIMD")
    assertEquals(json("cells")(1)("meanMs").num, 25.0)
    assertEquals(json("truth").num, 8.0)
    assertEquals(json("sentence").str, map.sentence(20))
    val texts = BudgetFigure(Vector(map)).shapes.collect { case text: Mark.Text => text.content }
    assert(texts.exists(_.contains("jitter")) && texts.exists(_.contains("mean")), texts)

  test("a marked link outside the map is reported, since it is not drawn"):
    def texts(link: LatencyDistribution) =
      val map =
        shown(Vector(8, 8.2, 8.6)).copy(marks = Vector(BudgetMark("one", link, RunningStats(2, 8, 0))))
      (
        map.markLines.head,
        BudgetFigure(Vector(map)).shapes.exists {
          case text: Mark.Text => text.content == "one"; case _ => false
        }
      )
    val (inside, isDrawn) = texts(LatencyDistribution.Constant(Span.ofMillis(40)))
    assert(!clue(inside).contains("not drawn") && isDrawn)
    val (outside, isDrawnToo) = texts(LatencyDistribution.Vpn)
    assert(clue(outside).endsWith("; not drawn: the map ends before it, at 100 and 20 ms") && !isDrawnToo)

  test("a map's legend lists the drawn items, and its colours suit the signs of the values"):
    def labels(truth: Vector[Double]) = BudgetFigure.legend(Vector(shown(truth))).map(_.label)
    assert(!labels(Vector(8, 8, 8)).exists(_.contains("off the truth")), labels(Vector(8, 8, 8)))
    assert(labels(Vector(8, 8.2, 9)).exists(_.contains("off the truth")), labels(Vector(8, 8.2, 9)))
    val scale = BudgetFigure.scaleOf(Vector(shown(Vector(8, 8.2, 9))))
    assertEquals(scale.from, 0.0)
    assert(BudgetFigure.scaleOf(Vector(shown(Vector(8, 7.5, 9)))).from < 0)
