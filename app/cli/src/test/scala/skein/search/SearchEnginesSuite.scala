package skein.search

import java.nio.file.Files
import skein.lanes.Engine
import skein.optimise.{Evaluator, RunningStats}
import skein.scenario.Scenarios
import skein.testing.{Optimised, TemporaryFolders}

/** The engine of a search's candidates, and that of its fresh episodes, are reported separately. */
class SearchEnginesSuite extends munit.FunSuite, TemporaryFolders, Optimised:
  private given Scenarios = Scenarios.ours

  private def setup(loop: String, link: String, eye: Option[String], candidates: Int = 256): ReadySearch =
    SearchQuestion(
      family = "lead-pursuit",
      role = "pursuer",
      objective = "last10s",
      method = "random",
      conditions = Conditions(loop, "reduced", 100, 12, eye = eye),
      link = link,
      opponent = "paper-evader turningRadiusM=8.0",
      candidates = candidates,
      episodes = 1,
      population = 4,
      seed = 1
    ).setup.fold(fail(_), identity)

  private def engines(loop: String, link: String, eye: Option[String]): String =
    setup(loop, link, eye).engines

  private def eyeFile(): String =
    Files.writeString(temporaryFolder().resolve("eye.conf"), SearchEnginesSuite.Eye).toString

  test("SIMD results equal those of the scalar reference, and a difference is reported"):
    val duel      = setup("stream", "vpn", eye = None)
    val episodes  = 0 until SearchResult.Checked
    val flown     = duel.judges(1)(Judge.Winner).tallies(Vector(duel.space.defaults), episodes).head
    val reference = duel.reference(duel.space.defaults, episodes).get
    assertNotEquals(flown.mean, reference.mean)
    assertEquals(SearchResult.disagreement(flown, reference, "m"), None)
    for other <- Seq(reference.copy(mean = 3 * reference.mean), reference.copy(mean = Double.NaN)) do
      assert(SearchResult.disagreement(flown, other, "m").exists(_.contains("the scalar engine comes to")))

  test("if candidates and winner use SIMD, each has its kernel in the description"):
    for
      loop <- Seq("sequential", "futures", "stream", "predictive")
      link <- Seq("vpn", "vpn-mixed")
      eye  <- Seq(None, Some(eyeFile()))
    do
      val told = engines(loop, link, eye)
      assert(told.matches("SIMD, .*; fresh episodes: SIMD, .*"), s"$loop, $link, $eye: $told")

  test("a few candidates have their own delays, whose SIMD kernel is faster for so few than a shared one"):
    assert(setup("stream", "vpn", None, candidates = 255).engines.matches("SIMD, [0-9]+ worlds at a time"))
    val paused = setup("paused", "vpn", Some(eyeFile()), candidates = 8).engines
    assert(paused.contains(" candidates of an episode at a time"), paused)

  test("fresh episodes with the scalar engine are reported, with the reason"):
    val seeing = engines("paused", "vpn", Some(eyeFile()))
    assert(
      seeing.matches("SIMD, .*; fresh episodes: scalar: a sensor under a loop that pauses the world .*"),
      seeing
    )

  for (scenario, varied, objective) <- Seq(
      ("surround", Varied("ring-m", 4, 12), "off-ring"),
      ("convoy", Varied("gap-m", 8, 20), "between-cars")
    )
  do
    test(
      s"the candidates of $scenario share delays with SIMD, and its fresh episodes have their own with SIMD"
    ):
      val team = TeamQuestion(
        scenario = scenario,
        set = Map.empty,
        vary = Vector(varied),
        objective = objective,
        method = "random",
        conditions = Conditions("stream", "drag", 100, 10),
        link = "vpn",
        candidates = 256,
        episodes = 1,
        population = 4,
        seed = 1,
        fresh = 2
      ).setup.fold(fail(_), identity)
      assert(
        team.engines.matches(
          "SIMD, .* candidates of an episode at a time; fresh episodes: SIMD, .* worlds at a time"
        ),
        team.engines
      )

  test("candidates with another engine are counted, and reported with its reason"):
    val by = new Evaluator:
      def tallies(candidates: Vector[Vector[Double]], episodes: Range): Vector[RunningStats] =
        candidates.map(_ => RunningStats.of(1)(_ => 0.0))
    val simd  = Engine(Engine.Kind.Lanes, "SIMD")
    val noted = NotedEvaluator(
      by,
      candidate => if candidate.head > 1 then Engine.scalar("a policy is no formula") else simd
    )
    noted.tallies(Vector(Vector(0.0), Vector(1.0)), 0 until 1): Unit
    assertEquals(noted.others(simd), None)
    noted.talliesUnless(() => false)(Vector(Vector(2.0), Vector(0.5), Vector(3.0)), 0 until 1): Unit
    // A round later.
    noted.tallies(Vector(Vector(2.0)), 1 until 2): Unit
    assertEquals(
      noted.others(simd),
      Some("of 5 candidates judged 2 by another engine, scalar: a policy is no formula")
    )

private object SearchEnginesSuite:
  val Eye: String =
    """skein.sensor {
      |  detection.value = 0.9
      |  bearing-sd-deg.value = 0.5
      |  range-bias.value = 1
      |  range-sd.value = 0.5
      |  every-s = 0.1
      |  fov-deg = 90
      |  farthest-m = 40
      |  workers = 2
      |  deadline-s = 0.3
      |  takes-ms = [15, 30, 60]
      |}
      |""".stripMargin
