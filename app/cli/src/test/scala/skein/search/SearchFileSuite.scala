package skein.search

import com.typesafe.config.Config
import java.nio.file.Files
import scala.jdk.CollectionConverters.*
import skein.learn.LearnerSettings
import skein.optimise.{Evaluator, SearchState, RunningStats}
import skein.scenario.{Measure, Scenario, ScenarioKind, Scenarios, Surround}
import skein.settings.{HoconFile, PolicyFile, ScenarioSettings}
import skein.testing.{Optimised, TemporaryFolders}
import skein.training.{LearnBest, LearnQuestion, LearnResult, LearnState}

class SearchFileSuite extends munit.FunSuite, TemporaryFolders, Optimised:
  private given Scenarios = Scenarios.ours

  private def question(method: String) = SearchQuestion(
    family = "paper-pursuer",
    role = "pursuer",
    objective = "0.9*last10s + 0.01*effort",
    method = method,
    conditions = Conditions("stream", "reduced", 100, 12),
    link = "vpn",
    opponent = "paper-evader turningRadiusM=8.0",
    candidates = 60,
    episodes = 4,
    population = 12,
    seed = 7
  )

  private def setup(method: String) = question(method).setup.fold(mistake => fail(mistake), identity)

  for method <- SearchQuestion.Methods.split(", ").toSeq do
    test(s"$method: a search stored and read back after every step ends as an uninterrupted one"):
      val ready                       = setup(method)
      val evaluator                   = ready.judges(2)(Judge.Candidates)
      def through(state: SearchState) =
        val text = SearchFile.json(SearchFile(SearchFile.Version, ready.question, state))
        SearchFile.parse(text).fold(mistake => fail(mistake), identity)
      def ended(next: SearchState => SearchState) =
        Iterator.iterate(ready.search.start)(next).find(_.isDone).get
      val unbroken = ended(ready.search.step(_, evaluator, Int.MaxValue))
      val broken   = ended: state =>
        val read = through(state)
        assertEquals(read.question, ready.question)
        ready.search.step(read.state, evaluator, 17)
      assertEquals(broken, unbroken)

  test("a change of a file that a question names is detected by its content"):
    val folder = temporaryFolder()
    val file   = Files.writeString(folder.resolve("link.txt"), "20\n30\n")
    val before = NamedFiles.digests(Seq(s"file:$file", "reduced", "vpn"))
    assertEquals(before.keySet, Set(file.toString))
    assertEquals(NamedFiles.changed(before), Vector.empty)
    Files.writeString(file, "150\n200\n")
    assertEquals(NamedFiles.changed(before), Vector(file.toString))
    assert(clue(NamedFiles.unchanged(
      before,
      "it"
    )).left.exists(_.startsWith(s"--resume: $file no longer holds")))
    Files.delete(file)
    assertEquals(NamedFiles.changed(before), Vector(file.toString))
    assertEquals(
      NamedFiles.unchanged(before, "the search"),
      Left(s"--resume: there is no file $file, which the search read: expected to go on with it")
    )
    assertEquals(
      NamedFiles.unchanged(Map("no/link.txt" -> "00"), "the search"),
      Left(
        "--resume: there is no file no/link.txt, which the search read: expected to go on with it, " +
          "from the folder in which it began"
      )
    )
    Files.delete(folder)

  folder.test("output for people can be read back, whatever files the question names"): folder =>
    val link  = s"file:${Files.writeString(folder.resolve("our \"own\" \\ $link.txt"), "20\n30\n")}"
    val tally = RunningStats.of(2)(_.toDouble)
    def read(text: String): Config =
      val file = Files.writeString(folder.resolve("policy.conf"), text).toString
      assert(PolicyFile.read(file).isRight, PolicyFile.read(file))
      HoconFile.read(file).fold(fail(_), identity)
    val ready = question("grid").copy(link = link).setup.fold(fail(_), identity)
    val found = ready.file(Found(ready.search.start, ready.space.defaults, tally, tally))._2
    assertEquals(read(found).getString("found.link"), link)
    val asked = LearnQuestion(
      "ppo",
      "pursuer",
      "last10s",
      Conditions("stream", "reduced", 100, 12),
      link,
      "paper-evader turningRadiusM=8.0",
      steps = 1,
      environments = 1,
      lessonS = 5,
      startLeastM = 3,
      startMostM = 30,
      turnRateRadPerS = 3,
      LearnerSettings(hidden = Vector(1), batch = 1),
      episodes = 2,
      fresh = 2,
      seed = 1
    )
    val setup   = asked.setup.fold(fail(_), identity)
    val weights = setup.family.space.defaults.dropRight(setup.bounds.size)
    val state   = LearnState(best = Some(LearnBest(1, 1, weights)))
    val learned = LearnResult(setup, state, setup.policy(weights), tally, tally, None).file
    assertEquals(read(learned).getString("learned.link"), link)

  test("text settings are used unchanged in flights and searches"):
    given Scenarios = Scenarios(ScenarioKind(SearchFileSuite.Signed()))
    val asked       = TeamQuestion(
      "signed",
      Map("sign" -> "a: \"b\" # c, {d}"),
      Vector(Varied("ring-m", 4, 12)),
      "off-ring",
      "grid",
      Conditions("stream", "drag", 100, 12),
      "vpn",
      candidates = 4,
      episodes = 2,
      population = 4,
      seed = 3,
      fresh = 4
    )
    val ready   = asked.setup.fold(fail(_), identity)
    val tally   = RunningStats.of(2)(_.toDouble)
    val written = ready.file(Found(ready.search.start, ready.space.defaults, tally, tally))._2
    val read    = HoconFile.parse(written, "scenario.conf").flatMap(ScenarioSettings.read)
    assertEquals(read, Right(ready.scenario(ready.space.defaults)))

  test("a run leaves its last state in the folder, and no partial file"):
    val folder = temporaryFolder()
    val ready  = setup("cma-es")
    var steps  = 0
    val run    = SearchRun(
      ready.search,
      ready.question,
      ready.judges(1)(Judge.Candidates),
      folder,
      () => System.nanoTime()
    )
    val state = run.run(ready.search.start, () => steps == 3)(_ => steps += 1)
    assertEquals(SearchFile.read(folder).map(_.state), state)
    assertEquals(Files.list(folder).iterator.asScala.map(_.getFileName.toString).toSeq, Seq(SearchFile.Name))
    Files.delete(folder.resolve(SearchFile.Name))
    Files.delete(folder)

  test(
    "a run stopped within a step keeps the previous state, and continues to an uninterrupted run's end"
  ):
    val folder = temporaryFolder()
    val ready  = setup("cma-es")
    val flying = ready.judges(1)(Judge.Candidates)
    var calls  = 0
    val cut    = new Evaluator:
      def tallies(candidates: Vector[Vector[Double]], episodes: Range): Vector[RunningStats] =
        calls += 1
        flying.tallies(candidates, episodes)
    def run(from: SearchState, isStopped: () => Boolean) =
      val states = Vector.newBuilder[SearchState]
      val last   =
        SearchRun(ready.search, ready.question, cut, folder, () => 0L).run(from, isStopped)(states += _)
      (last.fold(mistake => fail(mistake), identity), states.result())
    val (unbroken, states) = run(ready.search.start, () => false)
    calls = 0
    val (stopped, _) = run(ready.search.start, () => calls == 3)
    assertEquals(stopped, states(1))
    assertEquals(SearchFile.read(folder).map(_.state), Right(stopped))
    assertEquals(run(stopped, () => false)._1, unbroken)
    Files.delete(folder.resolve(SearchFile.Name))
    Files.delete(folder)

  test("a file that is not a search state, or was changed, is refused"):
    val ready = setup("cma-es")
    val whole = SearchFile.json(SearchFile(SearchFile.Version, ready.question, ready.search.start))
    for (text, part) <- Seq(
        "{}"                                            -> "begins with its version",
        "nonsense"                                      -> "state of a search",
        "[" * 100_000                                   -> "state of a search",
        """{"version":99,"state":{}}"""                 -> "expected version 2, got 99",
        whole.dropRight(30)                             -> "cut off",
        whole.dropRight(1)                              -> "cut off",
        whole.replace("\"mean\":[", "\"mean\":[1,")     -> "damaged or edited",
        whole.replace("cma-es", "grid")                 -> "damaged or edited",
        whole.replace("paper-pursuer", "paper-pürsuer") -> "damaged or edited",
        whole.dropRight(3) + "0}"                       -> "damaged or edited"
      )
    do
      assertNotEquals(text, whole)
      val mistake = SearchFile.parse(text).left.getOrElse("accepted")
      assert(mistake.contains(part), mistake)
      assert(mistake.length < 200, mistake)

  test("the predictive loop and an alternating link are accepted"):
    val asked = question("cma-es").copy(
      link = "vpn-mixed",
      conditions = Conditions("predictive", "reduced", 100, 12)
    )
    assert(asked.setup.isRight, asked.setup)

  test("moves in flight are a setting of the loop, and are printed unless they are the default two"):
    def asked(moves: Int) =
      question("cma-es").copy(conditions =
        Conditions("predictive", "reduced", 100, 12, movesInFlight = moves)
      )
    for (moves, text) <- Seq(2 -> "predictive", 6 -> "predictive with 6 moves in flight") do
      val ready = asked(moves).setup.fold(fail(_), identity)
      assertEquals(ready.loop, text)
      ready.flownBy match
        case TeamEngine.Reduced(conditions, _) =>
          assertEquals(conditions.timing.steering.mostOutstanding, moves)
        case other => fail(other.toString)

  for
    (name, wrong, parts) <- Seq(
      ("family", question("cma-es").copy(family = "nosuch"), Seq("--family", "paper-pursuer", "'nosuch'")),
      ("objective", question("cma-es").copy(objective = "best"), Seq("--objective", "character 1", "'best'")),
      ("method", question("luck"), Seq("--method", "cma-es", "'luck'")),
      ("link", question("cma-es").copy(link = "pigeon"), Seq("--link", "pigeon")),
      (
        "loop",
        question("cma-es").copy(conditions = Conditions("plan", "reduced", 100, 12)),
        Seq("--loop", "plan")
      ),
      (
        "model",
        question("cma-es").copy(conditions = Conditions("stream", "balloon", 100, 12)),
        Seq("--plant", "quadrotor", "'balloon'")
      ),
      (
        "duration",
        question("cma-es").copy(conditions = Conditions("stream", "reduced", 100, 2)),
        Seq("--duration", "10 s")
      ),
      (
        "number of moves in flight",
        question("cma-es").copy(conditions = Conditions("stream", "reduced", 100, 12, movesInFlight = 33)),
        Seq("--moves-in-flight", "1 to 32", "33")
      ),
      ("population", question("cma-es").copy(population = 2), Seq("--population", "4")),
      ("episodes", question("grid").copy(episodes = 0), Seq("--episodes", "0")),
      (
        "number of a race's episodes",
        question("racing").copy(candidates = 100_000, episodes = 200),
        Seq("--episodes", "at most 128", "200")
      )
    )
  do
    test(s"a wrong $name is refused with the option's name"):
      val mistake = wrong.setup.left.getOrElse("accepted")
      for part <- parts do assert(mistake.contains(part), mistake)

object SearchFileSuite:
  final case class Signed(sign: String = "", ringM: Double = 8) extends Scenario:
    def agents                             = Surround(ringM = ringM).agents
    override def measures: Vector[Measure] = Surround(ringM = ringM).measures
