package skein.cli

import java.io.{DataInput, DataOutput, IOException}
import java.nio.file.{Files, Path}
import skein.learn.{Learner, Network, Task}
import skein.optimise.RunningStats
import skein.policy.{Agent, Role, Surrounding}
import skein.scenario.*
import skein.search.Judge
import skein.settings.PolicyFile
import skein.testing.{Optimised, TemporaryFolders}
import skein.training.*
import skein.units.{MetresPerSecond, Radians, Vector3}

class LearnCommandSimulation extends munit.FunSuite, TemporaryFolders, Optimised:
  private given Scenarios = Scenarios.ours

  private val short =
    ("--steps 2000 --environments 16 --lesson 5s --network 8 --episodes 2 --fresh 4 --flights 1 " +
      "--duration 12s --updates-per-step 0.02 --threads 1").split(' ').toSeq

  private def run(words: Seq[String]): (Int, String, String) =
    val ran = Ran.of(Main.run("learn" +: words))
    (ran.status, ran.out, ran.err)

  for (algorithm, side) <- Seq("sac" -> "pursuer", "ddpg" -> "evader", "ppo" -> "pursuer") do
    test(s"$algorithm teaches the $side, and writes a policy that can be read back"):
      val folder             = temporaryFolder().resolve("learned")
      val (status, out, err) =
        run(
          Seq("--algorithm", algorithm, "--side", side, "--json", "--out", folder.toString) ++
            (if algorithm == "ppo" then short.patch(short.indexOf("--updates-per-step"), Nil, 2) else short)
        )
      assertEquals(status, 0, err)
      assert(err.contains("engine: SIMD, "), err)
      val rows = ujson.read(out)("tables")(0)("rows").arr
      assertEquals(rows.map(_(0).str).toSeq, Seq("learned:8", s"paper-$side", "learned:8"))
      assertEquals(rows.map(_(4).num).toSeq, Seq(4.0, 4.0, 1.0))
      val policy = PolicyFile.read(folder.resolve("policy.conf").toString).fold(fail(_), identity)
      assertEquals(PolicyFile.name(policy.role), side)
      assertEquals(policy.family.name, "learned:8")
      assert(Files.size(folder.resolve("learning-curve.svg")) > 1000)

  test(
    "a team's pursuers learn one policy, which replaces the policy of each in flights and forward simulation"
  ):
    val folder = temporaryFolder().resolve("learned")
    val words  = "--scenario surround --set vehicles=4 --objective off-ring --json".split(' ').toSeq
    val (status, out, err) = run(words ++ Seq("--out", folder.toString) ++ short)
    assertEquals(status, 0, err)
    assert(err.contains("engine: SIMD, "), err)
    val rows = ujson.read(out)("tables")(0)("rows").arr
    assertEquals(rows.map(_(0).str).toSeq, Seq("learned:8", "surround's own", "learned:8"))
    assertEquals(rows.map(_(5).str).toSeq, Seq("m", "m", "m"))
    // A policy after this few steps flies away, here as in flight.
    val Seq(learned, own, flown) = rows.map(_(2).num).toSeq: @unchecked
    assert(own < learned - 10 && math.abs(flown - learned) < 5, rows.toString)

  test("a pursuer that climbs is learned by tilt, flies, and learns on in flight"):
    val folder             = temporaryFolder().resolve("learned")
    val words              = Seq("--climb", "2", "--batch", "32", "--json", "--out", folder.toString)
    val (status, out, err) = run(words ++ short)
    assertEquals(status, 0, err)
    assert(err.contains("engine: SIMD, ") && err.contains("in space"), err)
    val rows = ujson.read(out)("tables")(0)("rows").arr
    assertEquals(rows.map(_(0).str).toSeq, Seq("climbing:8", "paper-pursuer", "climbing:8"))
    val policy = PolicyFile.read(folder.resolve("policy.conf").toString).fold(fail(_), identity)
    assertEquals(policy.text.split(' ').takeRight(2).toSeq, Seq("turnRad=0.0", "climbMps=2.0"))
    val flight =
      "fly --clock virtual --loop stream --link vpn --duration 6s --learn-version 10".split(' ').toSeq
    val flown  = folder.resolve("flown")
    val beside = Ran.of(Main.run(flight ++ Seq("--learn", folder.toString, "--out", flown.toString)))
    assertEquals(beside.status, 0, beside.said)
    val file = flown.resolve("stream-vpn-learning.duckdb")
    assertEquals(Ran.of(Main.run(Seq("replay", file.toString))).status, 0)

  test("a learned policy continues to learn in flight, and a replay has an equal digest"):
    val folder           = temporaryFolder()
    val learned          = folder.resolve("learned").toString
    val (status, _, err) = run(Seq("--out", learned, "--batch", "32") ++ short)
    assertEquals(status, 0, err)
    def flown(words: String*) =
      val ran = Ran.of(Main.run(words))
      (ran.status, ran.said)
    val flight =
      Seq(
        "fly",
        "--clock",
        "virtual",
        "--loop",
        "stream",
        "--link",
        "vpn",
        "--duration",
        "6s",
        "--learn",
        learned
      )
    val (landed, said) =
      flown(flight ++ Seq("--learn-version", "10", "--out", folder.resolve("flown").toString)*)
    assertEquals(landed, 0, said)
    val file      = folder.resolve("flown/stream-vpn-learning.duckdb")
    val recording = skein.record.RecordingReader.read(file).fold(error => fail(error.message), identity)
    val versions  = recording.events.filter(_.kind == skein.record.EventKind.Learned)
    assert(versions.size >= 3, versions)
    assertEquals(
      recording.heading.parametersOf("version").keySet,
      versions.flatMap(_.decision).map(_.toString).toSet
    )
    val (same, told) = flown("replay", file.toString)
    assertEquals(same, 0, told)
    val (packed, reason) = flown(flight ++ "--loop predictive --plan-in-packet --out no".split(' ')*)
    assertEquals(packed, 1, reason)
    assert(reason.contains("--plan-in-packet: expected policies that do not learn in flight"), reason)
    val (refused, why) = flown(flight ++ Seq("--learn-noise", "2", "--out", folder.resolve("not").toString)*)
    assertEquals(refused, 1, why)
    assert(why.contains("--learn-noise: expected 0.0 to 1, got 2.0"), why)

  test("learning that is stopped and continued has the result of an uninterrupted run, to the bit"):
    val question = LearnCommand
      .question(LearnOptionsOf(short))
      .fold(fail(_), identity)
    val setup = question.setup.fold(fail(_), identity)
    def learn(folder: Path, from: LearnState, rounds: Int) =
      // Enough time passes that every round is saved.
      var (done, now) = (from.rounds, 0L)
      def later()     =
        now += 60_000_000_000L
        now
      LearnRun(setup, setup.judges(1)(Judge.Candidates), Some(folder), () => later())
        .run(from, 1, () => done >= rounds)(state => done = state.rounds)
        .flatMap(_.unfailing)
        .fold(fail(_), identity)
    val whole  = learn(temporaryFolder(), LearnState(), setup.rounds)
    val folder = temporaryFolder()
    assert(setup.rounds >= 3, setup.rounds.toString)
    learn(folder, LearnState(), 1): Unit
    val file = LearnFile.read(folder).fold(fail(_), identity)
    assertEquals(file.state.rounds, 1)
    assertEquals(file.question, question)
    assertEquals(learn(folder, file.state, setup.rounds), whole)

  test("interrupted training prints how to resume it, then evaluates the best policy in fewer episodes"):
    val question = LearnCommand
      .question(LearnOptionsOf(short.updated(short.indexOf("--fresh") + 1, "150")))
      .fold(fail(_), identity)
    val setup       = question.setup.fold(fail(_), identity)
    val folder      = temporaryFolder()
    var (now, done) = (0L, 0)
    def later()     =
      now += 60_000_000_000L
      now
    LearnRun(setup, setup.judges(1)(Judge.Candidates), Some(folder), () => later())
      .run(LearnState(), 1, () => done == 1)(state => done = state.rounds)
      .fold(fail(_), learned => assert(learned.state.best.isDefined))
    val interrupting = Thread.ofVirtual().start: () =>
      while !Thread.interrupted() do
        Edge.interrupt()
        Thread.`yield`()
    val (status, out, err) =
      try run(Seq("--resume", folder.toString))
      finally interrupting.interrupt()
    assertEquals(status, 0, err)
    val lines = out.linesIterator.toVector
    val goOn  = lines.indexOf(s"stopped; ./skein learn --resume $folder goes on")
    val row   = lines.indexWhere(_.startsWith("learned:8"))
    assert(goOn >= 0 && row > goOn, out)
    assert(lines(row).contains(" 100  m"), out)

  test("learning does not continue over a link whose file has changed"):
    val folder   = temporaryFolder()
    val link     = Files.writeString(folder.resolve("link.txt"), "20\n30\n")
    val question =
      LearnCommand.question(LearnOptionsOf(short ++ Seq("--link", s"file:$link"))).fold(fail(_), identity)
    val setup = question.setup.fold(fail(_), identity)
    LearnRun(setup, setup.judges(1)(Judge.Candidates), Some(folder), () => 0L)
      .run(LearnState(), 1, () => true)(_ => ())
      .fold(fail(_), learned => assertEquals(learned.state.rounds, 0))
    Files.writeString(link, "150\n200\n"): Unit
    val (status, _, err) = run(Seq("--resume", folder.toString))
    assertEquals(status, 1, err)
    assert(clue(err).contains(s"--resume: $link no longer holds what it held when learning began"))

  test("learning whose baseline another program scored otherwise does not continue"):
    val folder   = temporaryFolder()
    val question = LearnCommand.question(LearnOptionsOf(short)).fold(fail(_), identity)
    val setup    = question.setup.fold(fail(_), identity)
    LearnRun(setup, setup.judges(1)(Judge.Candidates), Some(folder), () => 0L)
      .run(LearnState(), 1, () => true)(_ => ())
      .fold(fail(_), learned => assertEquals(learned.state.rounds, 0))
    val file  = LearnFile.read(folder).fold(fail(_), identity)
    val other = file.copy(probe = file.probe.map(_ => RunningStats.of(4)(_ + 0.5)))
    assertEquals(LearnFile.write(folder, other, Numbers(isFull = false)), Right(()))
    val (status, _, err) = run(Seq("--resume", folder.toString))
    assertEquals(status, 1, err)
    assert(clue(err).contains("they scored 2.0 when learning began: expected the program of that time"))

  test("an exception of user code during learning is reported, and the best policy so far is kept"):
    object Own extends SkeinApp(ScenarioKind(LearnedUntilItFails()))
    val folder = temporaryFolder().resolve("learned")
    val words  = "learn --scenario learned-until-it-fails --objective off".split(' ').toSeq ++ short
    val ran    = Ran.of(Own.run(words ++ Seq("--out", folder.toString)))
    assertEquals(ran.status, 1)
    val line = ran.err.linesIterator.toVector.last
    val why  = "the quantity BreaksLate failed: java.lang.IllegalStateException: no such luck"
    assert(clue(line).startsWith(s"skein learn: $why (LearnCommandSimulation.scala:"))
    assert(clue(ran.out).contains(s"the best policy until then: $folder/policy.conf"))
    assert(PolicyFile.read(folder.resolve("policy.conf").toString).isRight)

  test("where a scenario's first vehicle is a car, learners fly at the altitude of its multirotors"):
    val words = "--scenario convoy --objective off-places".split(' ').toSeq
    assertEquals(LearnCommand.question(LearnOptionsOf(words)).map(_.conditions.altitudeM), Right(10.0))

  test("an impossible learning task is refused in a line"):
    def refused(expected: String, words: String*) =
      val (status, _, err) =
        run(words ++ Seq("--out", temporaryFolder().resolve("no").toString))
      assert(status != 0)
      assert(clue(err).contains(expected))
      assertEquals(err.linesIterator.size, 1)
    refused("--algorithm: expected sac, ddpg, ppo, got 'td3'", "--algorithm", "td3")
    refused("--scenario: expected duel, surround", "--scenario", "surrond")
    refused(
      "--objective: expected a sum of the measures of surround: off-ring, ring, gap",
      "--scenario",
      "surround"
    )
    refused("expected settings of the scenario, got --altitude", "--scenario", "surround", "--altitude", "9")
    def team(scenario: String, objective: String) = Seq("--scenario", scenario, "--objective", objective)
    refused(
      "expected one of off-ring, ring, nearest, gap, surrounded-after, got 'rang'",
      team("surround", "rang")*
    )
    refused("expected means over time, or one root mean square alone", team("surround", "nearest")*)
    refused("learners: expected one of leader, follower", team("formation", "slot-rms")*)
    refused("no measure of a quantity", team("blind-pursuit", "distance")*)
    refused("plant: expected tilt or quadrotor, got drag: learners climb", "--climb=2", "--plant=drag")
    refused("--climb: expected 0.0 to 50 m/s, got -1 m/s", "--climb=-1")
    refused("--side: expected pursuer or evader", "--side", "both")
    refused("--network: expected", "--network", "0x3")
    refused("discount: expected 0 up to less than 1", "--discount", "NaN")
    refused("--learning-rate: expected", "--learning-rate", "-1")
    refused("--start: expected LEAST..MOST", "--start", "30..3")
    refused("--steps: expected 1 to 1000000000000, got 0", "--steps", "0")
    refused("--environments: expected 1 to 65536, got 65537", "--environments", "65537")
    refused(
      "--steps: expected at most 21474836470, which are 2147483647 lessons in each environment, got 30000000000",
      "--steps 30000000000 --environments 1 --lesson 1s".split(' ').toSeq*
    )
    refused(
      "--set: expected 'vehicles' once, got 4 and 6",
      team("surround", "off-ring") ++ "--set vehicles=4 --set vehicles=6".split(' ')*
    )
    refused("--batch: expected at most", "--algorithm", "ppo", "--batch", "60000")
    refused(
      "--updates-per-step: expected with sac or ddpg, got ppo",
      "--algorithm",
      "ppo",
      "--updates-per-step",
      "1"
    )

  folder.test("on a full disk the learner's previous file is kept"): path =>
    val question = LearnCommand.question(LearnOptionsOf(short)).fold(fail(_), identity)
    def written(rounds: Int, isFull: Boolean) =
      LearnFile.write(path, LearnFile(LearnFile.Version, question, LearnState(rounds)), Numbers(isFull))
    assertEquals(written(1, isFull = false), Right(()))
    assert(clue(written(
      2,
      isFull = true
    )).left.exists(_.endsWith("learner-2.bin: No space left on device")))
    assertEquals(path.toFile.list.toSet, Set("learn.json", "learner-1.bin"))
    assertEquals(written(3, isFull = false), Right(()))
    assertEquals(path.toFile.list.toSet, Set("learn.json", "learner-3.bin"))

  test("a folder with other content, or with a damaged state, is not continued"):
    val folder = temporaryFolder()
    assert(
      LearnFile.read(folder).left.exists(_.contains("expected the folder of learning, of ./skein learn"))
    )
    Files.writeString(folder.resolve(LearnFile.Name), "{}"): Unit
    for below <- Seq(LearnFile.Name, s"${LearnFile.Name}/in") do
      assert(clue(LearnFile.read(folder.resolve(below))).left.exists(_.endsWith(
        "expected the folder of learning, of ./skein learn, got a file"
      )))
    assert(LearnFile.read(folder).left.exists(_.contains("expected the state of learning")))
    val question = LearnCommand.question(LearnOptionsOf(short)).fold(fail(_), identity)
    val setup    = question.setup.fold(fail(_), identity)
    val rounds   = LearnRun(setup, setup.judges(1)(Judge.Candidates), Some(folder), () => 0)
    var done     = 0
    assertEquals(
      rounds.run(LearnState(), 1, () => done == setup.rounds)(_ => done += 1).map(_.state.rounds),
      Right(done)
    )
    val state   = LearnFile.read(folder).fold(fail(_), identity).state
    val json    = folder.resolve(LearnFile.Name)
    val edited  = Files.readString(json).replace("\"scores\":[{", "\"scores\":[],\"was\":[{")
    val numbers = folder.resolve(s"learner-$done.bin")
    val written = Files.readAllBytes(numbers)
    def goingOn(bytes: Array[Byte]) =
      Files.write(numbers, bytes): Unit
      rounds.run(state, 1, () => true)(_ => ()).left.getOrElse("accepted")
    assertEquals(goingOn(written), "accepted")
    assert(clue(goingOn(written.updated(
      written.length / 2,
      (written(written.length / 2) ^ 1).toByte
    ))).contains("damaged"))
    assert(clue(goingOn(written.take(1000))).contains("cut off"))
    assert(clue(goingOn(written :+ 0.toByte)).contains("damaged"))
    assert(clue(goingOn(Array.fill(64)(7.toByte))).contains("numbers of such a learner"))
    Files.delete(numbers)
    assert(clue(rounds.run(state, 1, () => true)(_ => ())).left.exists(_.contains(s"there is no $numbers")))
    Files.writeString(json, edited): Unit
    assert(clue(LearnFile.read(folder)).left.exists(_.contains("damaged or edited")))

/** @param isFull whether the disk is full when its numbers are written */
private final class Numbers(isFull: Boolean) extends Learner:
  def actor: Network                                                     = ???
  def begin(round: Long): Unit                                           = ()
  def explore(seen: Array[Float], actions: Array[Float]): Unit           = ()
  def learn(seen: Array[Float], actions: Array[Float], task: Task): Unit = ()
  def isFinite: Boolean                                                  = true
  def load(in: DataInput): Unit                                          = ()
  def save(out: DataOutput): Unit                                        =
    out.write(new Array[Byte](4_000_000))
    if isFull then throw IOException("No space left on device")

private def LearnOptionsOf(words: Seq[String]): LearnOptions =
  mainargs.ParserForClass[LearnOptions].constructOrThrow(words)

/** A scenario whose quantity starts to fail after the policy was first evaluated. */
final case class LearnedUntilItFails() extends Scenario:
  def agents: Vector[Agent] = Vector(
    Agent("Evader", Role.Evader, MetresPerSecond(4), Vector3(30, 0, -5), Radians(0), Surrounding(1, 8, 4)),
    Agent("Pursuer", Role.Pursuer, MetresPerSecond(8), Vector3(0, 0, -5), Radians(0), Surrounding(0, 8, 8))
  )
  override def measures: Vector[Measure] = Vector(Series.of("off", "m", BreaksLate).mean("off"))

case object BreaksLate extends Quantity:
  private var calls = 0

  def of(positions: Positions): Double =
    calls += 1
    if calls >= 2000 then throw IllegalStateException("no such luck")
    positions.distanceM(0, 1)
