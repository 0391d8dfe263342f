package skein.cli

import java.io.ByteArrayOutputStream
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.{Files, Path}
import java.util.concurrent.TimeUnit
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.ExecutionContext.Implicits.global
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future, blocking}
import scala.jdk.CollectionConverters.*
import skein.airsim.WorldSettings
import skein.benchmark.BenchmarkSimulation
import skein.docs.Documentation
import skein.gpu.CudaGpu
import skein.link.{Address, TcpTransport}
import skein.mujoco.MujocoLibrary
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.{Lengthy, Optimised}
import skein.units.Clock

/** Documented flights in real time. */
class DocumentedFlightsLiveSuite
    extends DocumentedCommands(DocumentedCommands.of(DocumentedCommands.Kind.Flight)),
      Lengthy

/** Documented commands that need several processes. */
class DocumentedClustersLiveSuite
    extends DocumentedCommands(DocumentedCommands.of(DocumentedCommands.Kind.Cluster)),
      Lengthy,
      Optimised

/** Documented searches and forward simulation, with SIMD. */
class DocumentedSearchesLiveSuite
    extends DocumentedCommands(DocumentedCommands.of(DocumentedCommands.Kind.Search)),
      Lengthy,
      Optimised

class DocumentedCommandsLiveSuite
    extends DocumentedCommands(DocumentedCommands.of(DocumentedCommands.Kind.Other)),
      Lengthy

/** One command of each kind and engine, before every commit: searches here, all others in
  * [[DocumentedSampleOfOthersLiveSuite]], so that they run side by side.
  */
class DocumentedSampleLiveSuite
    extends DocumentedCommands(DocumentedCommands.sample(DocumentedCommands.Kind.Search)),
      Optimised

class DocumentedSampleOfOthersLiveSuite
    extends DocumentedCommands(
      DocumentedCommands.sample(DocumentedCommands.Kind.Other) ++ DocumentedCommands.sampleFlight
    ),
      Optimised

/** Runs the commands of README, guides, results and examples as written there, for a shorter time;
  * [[DocumentedCommands.leftOut]] states which are not run, and why. Real sockets on loopback.
  */
abstract class DocumentedCommands(commands: Seq[String]) extends munit.FunSuite:
  import DocumentedCommands.files
  private given system: ActorSystem = ActorSystem("documented-commands")
  private lazy val folder           = Files.createTempDirectory("documented")

  /** A simulator with the vehicles of the guide and the experiment. */
  private lazy val server =
    val page  = Files.readString(Documentation.root.resolve("docs/guides/airsim.md"))
    val text  = "(?s)```json\n(.*?)```".r.findFirstMatchIn(page).get.group(1)
    val world = WorldSettings.parse(text).fold(error => fail(error.message), identity)
    Edge.await(
      SimulatorServer.start(SimulatorSettings(world, Address("127.0.0.1", 0)), TcpTransport(), Clock.system)
    )

  /** A short flight to look at, and a policy that a short search found; each made once. */
  private lazy val recording: Path = made("fly", "--clock", "virtual", "--loop", "stream", "--link", "vpn")(
    "--duration",
    "12s"
  ).resolve("stream-vpn.duckdb")
  private lazy val policy: Path = files(made("search")(forward*)).find(_.toString.endsWith("policy.conf")).get
  private lazy val learned: Path =
    files(made("learn", "--network", "8")(learn*)).find(_.toString.endsWith("policy.conf")).get
  private lazy val onnx: Path =
    val file           = folder.resolve("pursuer.onnx")
    val (status, told) = run(Seq("policy", learned.toString, "--onnx", file.toString))
    assertEquals(status, 0, told)
    file
  private lazy val scenario: Path =
    files(made("search --scenario surround --vary ring-m=4..12 --objective off-ring".split(' ')*)(team*))
      .find(_.toString.endsWith("scenario.conf"))
      .get

  /** A recording with camera images, long enough to identify a sensor model. */
  private lazy val seeing: Path =
    made("fly", "--scenario", "blind-pursuit", "--clock", "virtual", "--loop", "stream", "--link", "none")(
      "--duration",
      "30s"
    ).resolve("stream-none.duckdb")
  private lazy val sensor: Path = made("identify", seeing.toString)().resolve("sensor.conf")

  override def afterAll(): Unit =
    val _ = Edge.await(system.terminate())
    files(folder).reverse.foreach(Files.delete)

  private val forward = Seq("--candidates", "16", "--episodes", "2", "--fresh", "8", "--duration", "12s")

  private val team =
    Seq("--set", "vehicles=4", "--candidates", "4", "--episodes", "1", "--fresh", "2", "--duration", "12s")

  private val learn =
    ("--steps 1000 --environments 16 --lesson 5s --episodes 2 --fresh 4 --flights 1 --duration 12s " +
      "--updates-per-step 0.02").split(' ').toSeq

  /** The command with options that make it short and set the folder of its results.
    *
    * @param live duration of flights in real time
    */
  private def shortened(words: Seq[String], out: Path, live: String = "2s"): Seq[String] =
    val more = words.head match
      case "fly" if words.contains("virtual")       => Seq("--duration", "2s")
      case "fly"                                    => Seq("--duration", live, "--twins", "0")
      case "spread"                                 => Seq("--duration", "2s")
      case "search" if words.contains("--scenario") => team
      case "search"                                 => forward
      case "learn"                                  => learn
      case "budget" if words.contains("--scenario") =>
        Seq("--means", "2", "--jitters", "2", "--episodes", "1", "--duration", "12s")
      case "budget"  => Seq("--means", "3", "--jitters", "2", "--episodes", "20", "--duration", "12s")
      case "latency" => Seq("--period", "5ms")
      case "torture" => Seq("--seeds", "2", "--duration", "12s")
      case _         => Seq.empty
    few(without(words, more)) ++ more ++
      Option.when(Set(
        "fly",
        "search",
        "learn",
        "budget",
        "latency",
        "link-fit",
        "new",
        "torture"
      )(words.head))(Seq(
        "--out",
        out.toString
      )).toSeq.flatten

  /** The words without the options that `others` set, and their values. */
  private def without(words: Seq[String], others: Seq[String]): Seq[String] =
    words.indices
      .filterNot(i =>
        Seq(i, i - 1).exists(at =>
          words.lift(at).exists(word => word.startsWith("--") && others.contains(word))
        )
      )
      .map(words)

  /** Reduces the number of flights, if a command states one. */
  private def few(words: Seq[String]): Seq[String] = words.indexOf("--seeds") match
    case -1 if words.head == "spread"           => words ++ Seq("--seeds", "2")
    case at if at > 0 && words.head == "spread" => words.updated(at + 1, "2")
    case _                                      => words

  private def made(words: String*)(more: String*): Path =
    val out            = Files.createTempDirectory(folder, "made")
    val (status, told) = run(words ++ more ++ Seq("--out", out.toString))
    assertEquals(status, 0, told)
    out

  /** Exit status and all output of a command. */
  private def run(words: Seq[String]): (Int, String) =
    val ran = Ran.of(Main.run(words))
    (ran.status, ran.said)

  /** Runs a flight in real time; repeats it once, longer, if a busy machine may have disturbed it. */
  private def flown(words: Seq[String]): (Int, String) =
    def out                    = Files.createTempDirectory(folder, "out").resolve("flown")
    def isSilent(said: String) =
      Seq("no answer from the simulator", "nothing was decided in").exists(said.contains)
    val first @ (status, told) = run(shortened(words, out))
    if status == 0 || DocumentedCommands.kindOf(
        words.mkString(" ")
      ) != DocumentedCommands.Kind.Flight || !isSilent(told)
    then first
    else
      println(s"flown once more, for the machine was too busy: ./skein ${words.mkString(" ")}: $told")
      val second @ (again, said) = run(shortened(words, out, live = "8s"))
      if again != 0 && isSilent(said) then
        println(s"INCONCLUSIVE: the machine is too busy to fly by the clock: ./skein ${words.mkString(" ")}")
        assume(false, "inconclusive")
      second

  /** Runs a command until it prints that it listens, then stops it. */
  private def runUntilItListens(words: Seq[String]): (Int, String) =
    val said  = ByteArrayOutputStream()
    val ended = Future(blocking(Console.withOut(said)(Console.withErr(said)(Main.run(words)))))
    while !said.toString.contains("127.0.0.1:") && !ended.isCompleted do Thread.sleep(20)
    val deadline = 30.seconds.fromNow
    // The command prints this before it waits.
    while !ended.isCompleted && deadline.hasTimeLeft() do
      Edge.interrupt()
      Thread.sleep(20)
    (Await.result(ended, 1.second), said.toString)

  /** Runs such a command in a separate process, and stops it as Ctrl-C would. */
  private def runAProcessUntilItListens(words: Seq[String]): (Int, String) =
    val jvm     = ProcessHandle.current.info.command.get
    val agents  = java.lang.management.ManagementFactory.getRuntimeMXBean.getInputArguments.asScala
    val process = ProcessBuilder(
      (Seq(jvm) ++ agents ++ Seq(
        "-XX:TieredStopAtLevel=1",
        "-cp",
        sys.props("java.class.path"),
        "skein.cli.Main"
      ) ++ words)*
    ).redirectErrorStream(true).start()
    val reader = process.inputReader(UTF_8)
    val said   = StringBuilder()
    var line   = reader.readLine
    while line != null && !line.contains("127.0.0.1:") do
      said.append(line).append('\n')
      line = reader.readLine
    said.append(line)
    process.toHandle.destroy(): Unit
    if !process.waitFor(30, TimeUnit.SECONDS) then process.destroyForcibly(): Unit
    (process.exitValue, said.toString)

  for command <- commands do
    test(s"./skein $command"):
      val settings = Files.writeString(
        folder.resolve("settings.json"),
        """{"SettingsVersion": 1.2, "SimMode": "Multirotor", "Vehicles": {"Evader": {"VehicleType": "SimpleFlight"}}}"""
      )
      val asked = DocumentedCommands.words(command).map:
        case "HOST:PORT" => server.address.toString
        case "NAME"      => "patrol"
        case "FOLDER"    => folder.resolve("results").toString
        case "FILE" if command.startsWith("policy") || command.contains("--policy FILE") => learned.toString
        case "FILE…" if command.startsWith("identify")                                   => seeing.toString
        case "FILE" | "FILE…"                                                            => recording.toString
        case "settings.json"                                                             => settings.toString
        case "searches/…/policy.conf"                                                    => policy.toString
        case "learned/…/policy.conf" | "learned/2026-11-22/policy.conf"                  => learned.toString
        case "learned/2026-11-22"          => learned.getParent.toString
        case "pursuer.onnx" | "other.onnx" => onnx.toString
        case "sensor.conf"                 => sensor.toString
        case "evader.onnx"                 => s"evader:$onnx"
        case "searches/…/scenario.conf"    => scenario.toString
        // A guide's later commands read what its earlier ones have written.
        case name if Set("flight.mcap", "my-bag", "again.duckdb", "pursuer.conf")(name) =>
          folder.resolve(name).toString
        case model if model.startsWith("mujoco:examples/") =>
          model.replace("examples/", s"${Documentation.root}/examples/")
        case word => word
      // The default port may be in use here.
      val words          = asked ++ (if asked.contains("--view") then Seq("--view-port", "0") else Nil)
      val (status, told) = words.head match
        case _ if words.exists(_.startsWith("mujoco:")) && MujocoLibrary.find.isLeft =>
          // Users install MuJoCo themselves: without it, one line states that.
          val (status, told) = run(words)
          (if told.contains("MuJoCo's library was not found") then 0 else status, told)
        case _ if words.contains("--gpu") && CudaGpu.find().isLeft =>
          // Without a GPU, one line states that.
          val (status, told) = run(words)
          (if told.contains("--gpu: ") then 0 else status, told)
        case "cluster" => run(words.updated(2, folder.resolve("certificates").toString))
        case "worker"  =>
          // There is no coordinator to join: one line states that.
          val (status, told) = run(words ++ Seq("--patience", "1ms"))
          (if told.contains("no coordinator at") then 0 else status, told)
        case "search" if words.contains("--cluster") =>
          val listening = words.updated(words.indexOf("--cluster") + 1, "127.0.0.1:0")
          runAProcessUntilItListens(listening ++ forward ++ Seq("--out", folder.resolve("cluster").toString))
        case "decide"                     => runUntilItListens(words ++ Seq("--at", "tcp://127.0.0.1:0"))
        case "serve" if words.sizeIs == 1 =>
          runAProcessUntilItListens(words ++ Seq("--listen", "127.0.0.1:0"))
        case "serve" => runUntilItListens(words ++ Seq("--listen", "127.0.0.1:0"))
        case "replay" if words.contains("--view") => runUntilItListens(words)
        case "link"                               =>
          // The guide's ports may be in use here.
          val own = words.updated(words.indexOf("--listen") + 1, "127.0.0.1:0")
          runUntilItListens(own.updated(own.indexOf("--to") + 1, server.address.toString))
        case "observe" if words.contains("--bag") => run(words)
        case "observe"                            =>
          // Without the guide's program, which belongs to the user.
          val own = without(words.takeWhile(_ != "--"), Seq("--simulator"))
          runUntilItListens(own ++ Seq("--listen", "127.0.0.1:0", "--simulator", server.address.toString))
        case _ if words.contains("recogniser=detector") =>
          // Users add its runtime themselves: without it, one line states that.
          val (status, told) = run(words)
          (
            if told.contains("onnxruntime, which runs models, is not on the class path") then 0 else status,
            told
          )
        case _ if words.exists(_.startsWith("unix:")) =>
          // Nothing answers at the guide's socket: one line states that.
          val (status, told) = run(words)
          (if told.contains("expected a policy behind the socket") then 0 else status, told)
        case _ => flown(words)
      val stopped = Set(0, 130, 143)
      assert(
        if Set(
            "serve",
            "link",
            "observe",
            "decide"
          )(words.head) && !words.contains("--bag") || words.contains("--view") || words.contains("--cluster")
        then
          stopped(status)
        else status == 0,
        s"exit $status:\n$told"
      )

object DocumentedCommands:
  enum Kind:
    case Flight, Cluster, Search, Other

  private def files(under: Path): Vector[Path] =
    val found = Files.walk(under)
    try found.iterator.asScala.toVector
    finally found.close()

  private def shown(page: Path): Vector[String] =
    """\./skein [^`\n#]+""".r.findAllIn(Files.readString(page)).map(_.stripPrefix("./skein ").trim).toVector

  private lazy val readme: Vector[String] = shown(Documentation.root.resolve("README.md"))

  /** The commands in their documented form, except those that are not run. */
  lazy val documented: Vector[String] =
    val pages = Seq("docs/guides", "docs/results", "examples").flatMap(under =>
      files(Documentation.root.resolve(under))
    )
    val shownThere = (pages :+ Documentation.root.resolve("docs/results.md"))
      .filter(page => page.toString.endsWith(".md") && !page.toString.contains("/target/"))
      .flatMap(shown)
    (readme ++ shownThere).distinct
      .filterNot(leftOut)

  def of(kind: Kind): Vector[String] = documented
    .map(inVirtualTime(_, readme))
    .filter(command => kindOf(command) == kind && !runElsewhere.contains(command) && !isOfReaders(command))

  /** A command that runs a reader's own program for minutes, in real time; [[MarginCommandLiveSuite]] runs
    * other programs.
    */
  private def isOfReaders(command: String) = command.startsWith("margin ")

  /** One command of each kind and engine. Commands in several processes, and flights in real time except one,
    * are left to the nightly run.
    */
  def sample(kind: Kind): Vector[String] =
    val engines = Seq(
      "--scenario",
      "--gpu",
      "mujoco:",
      "--mavlink",
      "--plant car",
      "--view",
      "--policy pursuer.onnx",
      "--onnx"
    )
    of(kind)
      // [[BenchmarkSimulation]] flies a small one.
      .filterNot(_.startsWith("benchmark "))
      .distinctBy(command => (command.takeWhile(_ != ' '), engines.filter(command.contains)))

  def sampleFlight: Option[String] = of(Kind.Flight).find(_ == "fly --loop predictive --link vpn")

  /** The words of a command. */
  def words(command: String): Vector[String] = """'([^']*)'|(\S+)""".r.findAllMatchIn(command).toVector.map(
    found => Option(found.group(1)).getOrElse(found.group(2))
  )

  /** Adds `--clock virtual` to flights of the guides that do not depend on real time. Flights of the README
    * stay live.
    */
  private def inVirtualTime(command: String, readme: Seq[String]): String =
    val isLive =
      Seq("--clock", "--ros", "--view", "--record", "--simulator", "unix:").exists(command.contains)
    if !command.startsWith("fly ") || isLive || readme.contains(command) then command
    else s"$command --clock virtual"

  /** Commands that are not run: placeholders for many commands, `identify` without the name of a recording,
    * and `margin` without a program. Examples also show `./sbtw …` and `python …`. The tests of those
    * projects run these programs (`./sbtw NAME/test`), `PythonPackageLiveSuite` runs `learn.py`; the other
    * Python programs need frameworks that are not installed here.
    */
  private def leftOut(command: String): Boolean =
    val standsForMany = Seq("--algorithm …", "--scenario NAME", "--loop …").exists(command.contains)
    standsForMany || Set("identify", "margin")(command)

  /** Commands that other suites run, with options that make them short. */
  private val runElsewhere: Map[String, Class[?]] = Map(
    "search --family lead-pursuit --workers 2"                          -> classOf[ClusterCommandsLiveSuite],
    "torture --workers 2"                                               -> classOf[ElsewhereLiveSuite],
    "fly --ros --loop predictive --link none --link vpn --duration 60s" -> classOf[FlyRosSuite],
    "benchmark"                                                         -> classOf[BenchmarkSimulation],
    "benchmark --policy FILE"                                           -> classOf[BenchmarkSimulation],
    "observe --ros"                                                     -> classOf[ObserveRosSuite],
    "observe --ros -- python my_node.py"                                -> classOf[ObserveRosSuite],
    "serve --ros"                                                       -> classOf[ServeRosSuite],
    "serve --ros --settings three.json"                                 -> classOf[ServeRosSuite],
    "serve --ros --settings three.json --speed 10"                      -> classOf[ServeRosSuite],
    "fly --clock virtual"                                               -> classOf[StartedLauncherLiveSuite],
    "--help"                                                            -> classOf[StartedLauncherLiveSuite]
  )

  def kindOf(command: String): Kind =
    val words = command.split(' ').toSeq
    if words.head == "fly" && !words.contains("virtual") then Kind.Flight
    else if Set("cluster", "worker")(words.head) || words.exists(Set("--cluster", "--workers")) then
      Kind.Cluster
    else if Set("search", "learn", "budget")(words.head) then Kind.Search
    else Kind.Other
