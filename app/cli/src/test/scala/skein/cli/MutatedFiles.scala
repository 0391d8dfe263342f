package skein.cli

import java.lang.management.ManagementFactory
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.{Files, Path}
import scala.util.Using
import skein.onnx.OnnxPolicy
import skein.policy.{PolicyFamily, Role}
import skein.record.{McapRecording, MemoryRecorder, RecordingReader}
import skein.report.{PaperReport, Report, ReportSections, SyntheticFlight}
import skein.scenario.Scenarios
import skein.settings.*
import skein.signal.SplitMix64
import skein.view.RecordedShow

/** Files that users name, each changed in a few places. A reader must accept such a file, or report each
  * wrong value in a line with its position.
  */
enum MutatedFiles(val suffix: String, base: => Array[Byte]):
  case Configuration extends MutatedFiles(".conf", MutatedFiles.configuration.getBytes(UTF_8))
  case SceneText     extends MutatedFiles(".conf", MutatedFiles.scene.getBytes(UTF_8))
  case Policy        extends MutatedFiles(".conf", MutatedFiles.policy.getBytes(UTF_8))
  case Model         extends MutatedFiles(".conf", MutatedFiles.model.getBytes(UTF_8))
  case Onnx          extends MutatedFiles(".onnx", MutatedFiles.onnx)
  case Mcap          extends MutatedFiles(".mcap", MutatedFiles.mcap)

  private lazy val whole  = base
  private lazy val pieces = if suffix == ".conf" then MutatedFiles.pieces else Vector.empty

  /** Reads the unchanged file, which must be accepted. */
  def unchanged(folder: Path)(using Scenarios): Either[String, Any] =
    read(Files.write(folder.resolve(s"whole$suffix"), whole), folder)

  /** Reads one mutant.
    *
    * @return the reader's mistake, if any; whether the file was accepted; and the processor time
    */
  def attempt(seed: Long, folder: Path)(using
      Scenarios
  ): (wrong: Option[String], isTaken: Boolean, cpuMs: Double) =
    val file = Files.write(folder.resolve(s"mutant$suffix"), mutant(seed))
    val from = MutatedFiles.cpuNanos
    val came =
      try Right(read(file, folder))
      catch case error: Throwable => Left(s"threw $error at ${error.getStackTrace.take(3).mkString(" ")}")
    val ms    = (MutatedFiles.cpuNanos - from) * 1e-6
    val wrong = came.fold(Some(_), _.left.toOption.flatMap(reason => MutatedFiles.untold(reason, file)))
    (wrong.map(what => s"${productPrefix} $seed: $what"), came.exists(_.isRight), ms)

  private def mutant(seed: Long): Array[Byte] =
    val random                 = SplitMix64(seed)
    def below(bound: Int): Int = random.nextInt(bound.max(1))
    (1 to 1 + below(3)).foldLeft(whole): (bytes, _) =>
      val at    = below(bytes.length)
      val until = (at + 1 + below(if random.nextDouble() < 0.8 then 8 else 400)).min(bytes.length)
      below(6) match
        case 0                    => bytes.take(at) ++ bytes.drop(until)
        case 1                    => bytes.take(until) ++ bytes.drop(at)
        case 2                    => bytes.take(at)
        case 3                    => bytes.updated(at, below(256).toByte)
        case _ if pieces.nonEmpty => MutatedFiles.withValue(bytes, below(1 << 30), pieces(below(pieces.size)))
        case 4 => bytes.take(at) ++ Array.fill(until - at)(below(256).toByte) ++ bytes.drop(until)
        case _ => bytes.updated(at, (bytes(at) ^ (1 << below(8))).toByte)

  private def read(file: Path, folder: Path)(using Scenarios): Either[String, Any] = this match
    case Configuration =>
      val options =
        FlightOptions.given_ParserForClass_FlightOptions.constructOrThrow(Seq("--config", s"$file"))
      options.settings.map(settings => settings.plans)
    case SceneText => NamedScene.read(s"$file")
    case Policy    => PolicyFile.read(s"$file")
    case Model     => ModelFile.read(s"$file")
    case Onnx      => PolicyFile.read(s"$file")
    case Mcap      =>
      val recording = folder.resolve("mutant.duckdb")
      Files.deleteIfExists(recording): Unit
      for
        _    <- McapRecording.read(file, recording).left.map(_.message)
        rows <- RecordingReader.records(recording).left.map(_.message)
        set  <- Report.read(Seq(recording)).left.map(_.map(_.message).mkString("\n"))
      yield
        RecordedShow.of(rows, RecordOptions.sceneOf): Unit
        ReportSections.text(set): Unit

object MutatedFiles:
  private val threads = ManagementFactory.getThreadMXBean

  /** Processor time of this thread, which reads everything. */
  private def cpuNanos: Long = threads.getCurrentThreadCpuTime

  /** Why a message is not fit for a person, if so. */
  private def untold(reason: String, file: Path): Option[String] =
    val said  = Complaint.text(reason)
    val lines = said.linesIterator.toVector
    val where = Seq(file.toString, file.getFileName.toString, "skein.fly", "mutant.duckdb")
    if lines.isEmpty || lines.exists(_.isBlank) then Some("says nothing")
    else if lines.sizeIs > Complaint.MostLines then
      Some(s"says ${lines.size} lines: ${lines.take(3).mkString(" / ")}")
    else
      lines
        .filterNot(_.endsWith(" mistakes more"))
        .find(line =>
          line.length > Complaint.MostOfALine + 40 || !where.exists(line.contains) || line.contains(
            "Exception"
          )
        )
        .map(line => s"says: $line")

  /** Texts that replace a value. */
  private val pieces: Vector[String] = Vector(
    "null",
    "{}",
    "[]",
    "[[]]",
    "{ a = 1 }",
    "true",
    "-1",
    "0",
    "1e999",
    "-0.0",
    "NaN",
    "1.5",
    "9223372036854775808",
    "\"\"",
    "\"a b\"",
    "'x'",
    "${x}",
    "${?x}",
    "${skein.fly.period}",
    "x" * 10_000,
    "1" * 400,
    "[1, null]",
    "§",
    "\"\\u0000\"",
    "\"\"\"a\nb\"\"\"",
    "{" * 300,
    "[" * 300,
    "10 ms",
    "-5 s",
    "1000000000000 days",
    "include file(\"/etc/hostname\")"
  )

  /** Replaces the value after one of the signs `=`. */
  private def withValue(bytes: Array[Byte], number: Int, piece: String): Array[Byte] =
    val signs = bytes.indices.filter(bytes(_) == '=')
    if signs.isEmpty then bytes
    else
      val at  = signs(number % signs.size) + 1
      val end = bytes.indexWhere(byte => byte == '\n' || byte == ',' || byte == '}', at)
      bytes.take(at) ++ piece.getBytes(UTF_8) ++ bytes.drop(if end < 0 then bytes.length else end)

  private def configuration = """skein.fly {
    |  loops = [stream, predictive, plan]
    |  links = [direct, "constant:100ms"]
    |  duration = 10 s
    |  period = 100 ms
    |  seed = 3
    |  scenario = surround
    |  surround { vehicles = 4, ring-m = 9 }
    |  predictor = drag
    |  moves-in-flight = 2
    |  deadline = 50 ms
    |  fallback = hold
    |  images = ["front_center@5"]
    |  planning { deadline = 40 ms, horizon-steps = 20, separation-m = 1 }
    |}
    |""".stripMargin

  private def scene = String(
    classOf[skein.scene.Scene].getResourceAsStream("street.conf").readAllBytes,
    UTF_8
  )

  private def policy =
    PolicyFile.ofDefaults(Role.Pursuer, PolicyFamily.parse("lead-pursuit").toOption.get).hocon("")

  private def model = """skein.model {
    |  use = lag
    |  altitude-m = 20
    |  lag { gain { value = 1 }, lag-s { value = 0.5 }, dead-time-s { value = 0.01 } }
    |}
    |""".stripMargin

  private def onnx =
    val family = PolicyFamily.parse("learned:8x4elu").toOption.get
    OnnxPolicy.write(
      family.policy(Vector.tabulate(family.space.dimension)(i => 0.01 * i)),
      "pursuer"
    ).toOption.get

  private def mcap =
    val folder    = Files.createTempDirectory("mutated")
    val recording = SyntheticFlight("stream", "direct", seed = 1, seconds = 2)
    val recorder  = MemoryRecorder(recording.heading)
    (recording.readings ++ recording.decisions ++ recording.commands).foreach(recorder.offer)
    val (from, to) = (folder.resolve("whole.duckdb"), folder.resolve("whole.mcap"))
    val written    = recorder.writeTo(from).flatMap(_ => McapRecording.write(from, to))
    assert(written.isRight, written)
    val bytes = Files.readAllBytes(to)
    Using.resource(Files.walk(folder))(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
    bytes

/** Tries many mutants of each kind, and prints the failures. */
@main def tryMutants(seed: Long, count: Int, kinds: String*): Unit =
  given Scenarios = PaperReport.scenarios
  val folder      = Files.createTempDirectory("mutants")
  for kind <- MutatedFiles.values if kinds.isEmpty || kinds.contains(kind.toString) do
    (1 to 20).foreach(warm => kind.attempt(-warm, folder)) // classes are loaded once
    val tried          = (0 until count).map(number => (seed + number) -> kind.attempt(seed + number, folder))
    val taken          = tried.count(_._2.isTaken)
    val (slowest, one) = tried.maxBy(_._2.cpuMs)
    tried.flatMap(_._2.wrong).foreach(println)
    println(
      f"$kind: $count mutants from seed $seed, $taken taken, ${count - taken} refused, " +
        f"${tried.count(_._2.wrong.isDefined)} wrong, slowest ${one.cpuMs}%.0f ms of processor time (seed $slowest)"
    )
