package skein.cli

import mainargs.{Flag, ParserForClass, arg}
import skein.benchmark.{Benchmark, BenchmarkSet, BenchmarkTables}
import skein.report.Section
import skein.scenario.Scenarios
import skein.units.Expect

/** Command-line options of `./skein benchmark`, with their help texts. */
final case class BenchmarkOptions(
    @arg(doc = "a task: duel, surround, formation or crossing; can be repeated; without one, all")
    task: Seq[String],
    @arg(doc = "how many times each entry flies each cell, each time with another seed")
    seeds: Int = 4,
    @arg(doc = Shown.Doc)
    json: Flag
)

/** `./skein benchmark`: every loop and predictor in a fixed set of tasks, links and worlds. */
final class BenchmarkCommand(using Scenarios)
    extends OptionsCommand[BenchmarkOptions](
      "benchmark",
      "flies a fixed set of tasks over links and in worlds unlike the model, and ranks loops and predictors",
      ParserForClass[BenchmarkOptions]
    ):

  protected def execute(options: BenchmarkOptions): Either[String, Unit] =
    val all   = BenchmarkSet.Published
    val names = all.tasks.map(_.name)
    for
      _ <- Expect.that(options.seeds >= 1 && options.seeds <= BenchmarkCommand.MostSeeds):
        s"--seeds: expected 1 to ${BenchmarkCommand.MostSeeds}, came ${options.seeds}"
      _ <- options.task
        .find(!names.contains(_))
        .map(came => s"--task: expected ${names.mkString(", ")}, came '$came'")
        .toLeft(())
      tasks     = all.tasks.filter(task => options.task.isEmpty || options.task.contains(task.name))
      benchmark = Benchmark(all.copy(tasks = tasks), options.seeds)
      line      = ProgressLine(benchmark.flights, Console.err)
      rows <-
        var landed = 0L
        benchmark.fly: more =>
          landed += more
          line.show(landed, "flights")
      _        = line.end()
      sections = BenchmarkTables.of(rows)
      _        = Shown(options.json.value).tables(sections, Section.text(sections))
      lost     = rows.flatMap(_.notFlown).distinct
      _ <- Expect.that(lost.isEmpty)(lost.mkString("\n"))
    yield ()

private object BenchmarkCommand:
  private val MostSeeds = 1000
