package skein.cli

import java.io.{ByteArrayOutputStream, PrintStream}
import java.nio.file.{Files, Path}
import scala.util.Using
import skein.record.MemoryRecorder
import skein.report.DuelReport
import skein.scenario.Scenarios

/** What is wrong is told in a line, before anything long is begun. */
class BadInputSuite extends munit.FunSuite:
  private given Scenarios = DuelReport.scenarios

  private val folder = FunFixture[Path](
    _ => Files.createTempDirectory("input"),
    path =>
      Using.resource(Files.walk(path))(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
  )

  private def assertRefused(command: Command, arguments: Seq[String], expected: String)(using
      munit.Location
  ): Unit =
    val said   = ByteArrayOutputStream()
    val status =
      Console.withErr(PrintStream(said))(Console.withOut(PrintStream(said))(command.run(arguments)))
    assert(status != 0)
    assert(clue(said.toString).contains(expected), s"expected: $expected")
    assert(said.toString.linesIterator.size <= 2)

  folder.test("a folder that cannot be made is told before the flight"): path =>
    val file     = Files.writeString(path.resolve("file"), "").toString
    val commands = Seq(
      FlyCommand(),
      SpreadCommand("skein.cli.Main"),
      SearchCommand("skein.cli.Main"),
      LearnCommand("skein.cli.Main"),
      BudgetCommand("skein.cli.Main"),
      LatencyCommand
    )
    for command <- commands do
      assertRefused(command, Seq("--out", s"$file/in"), "--out: cannot write into the folder")
      assertRefused(command, Seq("--out", ""), "--out: expected a folder, came ''")

  folder.test("a view that could not be looked at is told before the flight"): path =>
    val out                                           = path.resolve("out")
    def refused(expected: String)(arguments: String*) =
      assertRefused(FlyCommand(), arguments ++ Seq("--out", out.toString), expected)
    refused("--view-port: expected with --view")("--view-port", "9000")
    refused("--view-port: expected 0 to 65535, came 65536")("--view", "--view-port", "65536")
    refused("./skein replay --view FILE")("--view", "--clock", "virtual")
    assertRefused(
      ReplayCommand(),
      Seq("--view-port", "9000", "x.duckdb"),
      "--view-port: expected with --view"
    )

  test("a tolerance without end holds for everything, and is refused"):
    for value <- Seq("Infinity", "NaN", "0", "-1") do
      assertRefused(
        BudgetCommand("skein.cli.Main"),
        Seq("--within", value),
        "--within: expected a number above 0, came"
      )

  folder.test(
    "a configuration that is a folder, is missing, is nested too deeply or has unknown keys is refused"
  ): path =>
    def config(text: String) = Files.writeString(path.resolve("fly.conf"), text).toString
    assertRefused(FlyCommand(), Seq("--config", path.toString), "expected a file, came the folder")
    assertRefused(FlyCommand(), Seq("--config", path.resolve("none").toString), "there is no file")
    assertRefused(FlyCommand(), Seq("--config", config("a = " + "[" * 200_000)), "nested too deeply")
    assertRefused(FlyCommand(), Seq("--config", config("skein.fly.seedd = 1")), "the nearest is 'seed'")
    assertRefused(FlyCommand(), Seq("--config", config("duration = 5 s")), "no setting 'duration'")

  folder.test("a policy of a number that is too large is refused"): path =>
    val file = Files.writeString(
      path.resolve("policy.conf"),
      "family = lead-pursuit\nparameters { turnRateRadPerS = 1e999, lead = 1, speedRatio = 0.5 }"
    )
    assertRefused(FlyCommand(), Seq("--policy", file.toString), "expected a finite number, came 'Infinity'")

  test("a simulator of endless speed is refused"):
    for speed <- Seq("Infinity", "NaN", "0", "1e9") do
      assertRefused(ServeCommand, Seq("--speed", speed), "--speed: expected more than 0 and up to 1000, came")

  folder.test("a recording that cannot be read, or would not be made, is told in a line"): path =>
    val unreadable = Path.of("/proc/self/mem")
    if Files.isRegularFile(unreadable) then
      assertRefused(ReportCommand(), Seq(unreadable.toString), s"cannot open recording $unreadable")
    for clock <- Seq("real", "virtual") do
      assertRefused(
        FlyCommand(),
        Seq("--out", path.resolve("a;b").toString, "--clock", clock),
        "expected a path without ';'"
      )

  folder.test("no password is shown of what --record does not know"): path =>
    for one <- Seq("Postgres://me:secret@db/flights", "postgres:me:secret@db", "mysql://db?password=secret")
    do
      val said = ByteArrayOutputStream()
      val out  = path.resolve("flights").toString
      assert(Console.withErr(PrintStream(said))(FlyCommand().run(Seq("--record", one, "--out", out))) != 0)
      assert(clue(said.toString).contains(s"came '${one.takeWhile(_ != ':')}:…'"))
      assert(!said.toString.contains("secret"))

  folder.test("a recording without vehicles is not replayed"): path =>
    val heading  = skein.report.SyntheticFlight("stream", "vpn", seed = 1, seconds = 12).heading
    val recorder = MemoryRecorder(heading.copy(vehicles = Nil))
    val file     = path.resolve("none.duckdb")
    assert(recorder.writeTo(file).isRight)
    assertRefused(ReplayCommand(), Seq(file.toString), "no vehicles")
