package skein.cli

import skein.report.PaperReport
import skein.scenario.Scenarios

class MisuseSuite extends munit.FunSuite:
  private given Scenarios = PaperReport.scenarios

  /** Exit status and the output before the hint at `--help`. */
  private def misused(command: Command[?], arguments: String*): (Int, Seq[String]) =
    val ran = Ran.of(command.run(arguments))
    (ran.status, ran.err.linesIterator.toSeq.dropRight(1))

  test("a mistake is reported on one line that names the option and says what is wrong"):
    for
      (command, arguments, line) <- Seq(
        (
          SearchCommand("skein.cli.Main"),
          Seq("--candidates", "x"),
          "--candidates: expected a whole number that is not too large, got 'x'"
        ),
        (
          BudgetCommand("skein.cli.Main"),
          Seq("--tolerance", "much"),
          "--tolerance: expected a number, got 'much'"
        ),
        (FlyCommand(), Seq("--model", "drag"), "--model: no such option any more; it is --predictor now"),
        (
          SpreadCommand("skein.cli.Main"),
          Seq("--model=drag"),
          "--model: no such option any more; it is --predictor now"
        ),
        (
          BudgetCommand("skein.cli.Main"),
          Seq("--model", "drag"),
          "--model: no such option any more; it is --plant now"
        ),
        (SearchCommand("skein.cli.Main"), Seq("--seed"), "--seed: expected a value behind it"),
        (
          SearchCommand("skein.cli.Main"),
          Seq("--seed", "1", "--seed", "2"),
          "--seed: expected once, got 1 and 2"
        ),
        (
          SearchCommand("skein.cli.Main"),
          Seq("--seeed", "1", "--period", "1s"),
          "--seeed: no such option or argument; the nearest is --seed"
        ),
        (
          SearchCommand("skein.cli.Main"),
          Seq("--latency", "1ms"),
          "--latency: no such option or argument"
        ),
        // Commands that take files.
        (
          ReportCommand(),
          Seq("a.duckdb", "--ouf=x"),
          "--ouf=x: no such option or argument; the nearest is --out"
        ),
        (DigestCommand, Seq("-x", "a.duckdb"), "-x: no such option or argument")
      )
    do
      val (status, lines) = misused(command, arguments*)
      assertEquals((status, lines.head), (2, s"skein ${command.name}: $line"))
