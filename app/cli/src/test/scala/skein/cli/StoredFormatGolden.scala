package skein.cli

import scala.io.Source
import skein.budget.BudgetQuestion
import skein.learn.LearnerSettings
import skein.optimise.{CmaEs, MethodState, RunningStats, Scored, SearchState}
import skein.policy.{PolicyFamily, Role}
import skein.search.*
import skein.settings.PolicyFile
import skein.training.{LearnBest, LearnFile, LearnQuestion, LearnScore, LearnState}
import upickle.default.{ReadWriter, read, write}

/** Stored states and questions to workers are written byte for byte as by earlier programs, and are read
  * back. A line of `stored-format.jsonl` is a value's text.
  */
class StoredFormatGolden extends munit.FunSuite:
  private lazy val lines =
    val source = Source.fromResource("stored-format.jsonl")
    try source.getLines().toVector
    finally source.close()

  private val stats      = RunningStats(3, 1.5, -0.0)
  private val scored     = Vector(Scored(Vector(1, 1e-9), stats), Scored(Vector(1e300, Double.NaN), stats))
  private val conditions = Conditions("stream", "reduced", 100, 12)
  private val others     =
    Conditions("predictive", "drag", 62.5, 12, 7, Some("eye \"a\".conf"), 6, Some("position=0.1"))

  private val duel = SearchQuestion(
    "paper-pursuer",
    "pursuer",
    "last10s",
    "grid",
    conditions,
    "vpn",
    "paper-evader turningRadiusM=8.0",
    4,
    1,
    4,
    7
  )

  private val team = TeamQuestion(
    "surround",
    Map("vehicles" -> "4"),
    Vector(Varied("ring-m", 4, 12)),
    "off-ring",
    "grid",
    Conditions("stream", "drag", 100, 12),
    "vpn",
    4,
    2,
    4,
    Long.MaxValue,
    4
  )

  private val learned = LearnQuestion(
    "ppo",
    "pursuer",
    "last10s",
    conditions,
    "vpn",
    "paper-evader turningRadiusM=8.0",
    1,
    1,
    5,
    3,
    30,
    3,
    LearnerSettings(hidden = Vector(1), batch = 1),
    2,
    2,
    1
  )

  private val searches =
    import MethodState.*
    val courses = Seq(
      Listed(1L << 60),
      Drawn(2, Vector(1, 2), Vector(0.1, Double.PositiveInfinity)),
      Adapted(CmaEs.State(1, Vector(1), 0.5, Vector(Vector(1, 2), Vector()), Vector(), Vector(3))),
      Raced(1, scored),
      PlayOff(64, scored),
      Ended
    )
    for (course, number) <- courses.zipWithIndex.toVector
    yield SearchFile(
      SearchFile.Version,
      if number % 2 == 0 then duel else team,
      SearchState(course, Vector(stats), scored.take(number), number),
      if number < 3 then Map.empty else Map("a/b.txt" -> "0f"),
      if number < 3 then Vector.empty else Vector(stats)
    )

  private val courses = Vector(
    LearnFile(2, learned, LearnState()),
    LearnFile(
      2,
      learned.copy(
        conditions = others,
        scenario = "surround",
        set = Map("a" -> "b"),
        climbMps = 2,
        learner = LearnerSettings()
      ),
      LearnState(4, Vector(LearnScore(1, 2.5, 0)), Some(LearnBest(1, 2, Vector(0.1, -3)))),
      Map("x" -> "y"),
      Vector(stats)
    )
  )

  private val budgets = Vector[BudgetQuestion](
    BudgetQuestion.OfDuel(
      "pursuer",
      PolicyFile.ofDefaults(Role.Pursuer, PolicyFamily.leadPursuit).text,
      "paper-evader turningRadiusM=8.0",
      "last10s",
      conditions,
      3
    ),
    BudgetQuestion.OfScenario(
      "surround",
      Map("vehicles" -> "4"),
      None,
      conditions.copy(plant = "drag"),
      false,
      3
    )
  )

  private val torture = Vector(
    TortureQuestion(1, None, None),
    TortureQuestion(1, Some("surround"), Some(Map("scene" -> "ü")))
  )

  private def all[A: ReadWriter](values: Vector[A]): Vector[String] = values.map: value =>
    val text = write(value)
    assertEquals(write(read[A](text)), text)
    text

  test("stored states and questions are written as ever"):
    val written =
      searches.map(SearchFile.json) ++ all(courses) ++ all(budgets) ++ all(torture) ++
        all(Vector(SpreadQuestion("{}", Vector("1f")), SpreadQuestion("", Vector.empty)))
    for (text, line) <- written.zipAll(lines, "", "") do assertEquals(text, line)

  test("states on disk are read"):
    for line <- lines.take(searches.size) do
      assertEquals(SearchFile.parse(line).map(SearchFile.json), Right(line))
