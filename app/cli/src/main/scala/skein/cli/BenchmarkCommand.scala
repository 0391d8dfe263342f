package skein.cli

import mainargs.{Flag, ParserForClass, arg}
import skein.benchmark.{Benchmark, BenchmarkFigure, BenchmarkSet, BenchmarkTables}
import skein.report.Section
import skein.scenario.Scenarios
import skein.units.Expect

/** Command-line options of `./skein benchmark`, with their help texts. */
final case class BenchmarkOptions(
    @arg(doc =
      "a task: duel, surround, formation, crossing, shadow or hidden-shadow; can be repeated; without one, and without " +
        "--scenario, all whose scenarios the program has; if there are none, its own scenarios"
    )
    task: Seq[String],
    @arg(doc = "a scenario of your own as a task, by its name or its file; can be repeated")
    scenario: Seq[String],
    @arg(doc =
      "an entry: sequential, stream, 'straight on', model, adaptive or 'plans in packets'; can be " +
        "repeated; without one, all"
    )
    entry: Seq[String],
    @arg(doc =
      "flies each entry with this policy too, in place of the scenario's, in the tasks that have its role: a " +
        "policy file, ONNX included, or unix:ROLE:PATH; can be repeated; the truth stays the scenario's policy"
    )
    policy: Seq[String],
    @arg(doc = "how many times each entry flies each cell, each time with another seed")
    seeds: Int = 4,
    @arg(doc = "folder for benchmark.json with the tables, and their picture benchmark.svg, benchmark.png")
    out: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

/** `./skein benchmark`: every loop and predictor in a fixed set of tasks, links and worlds. */
final class BenchmarkCommand(using Scenarios)
    extends Command[BenchmarkOptions](
      "benchmark",
      "flies a fixed set of tasks over links and in worlds unlike the model, and ranks loops and predictors",
      ParserForClass[BenchmarkOptions]
    ):

  protected def execute(options: BenchmarkOptions): Either[String, Unit] =
    val all = BenchmarkSet.Published
    for
      _     <- Expect.within("--seeds", options.seeds, 1, BenchmarkCommand.MostSeeds)
      tasks <- chosen("--task", options.task, all.tasks)(_.name)
      own   <- Expect.all(options.scenario)(name =>
        summon[Scenarios].kind(name).left.map("--scenario: " + _).map(_ => BenchmarkSet.Named.of(name))
      )
      entries <- chosen("--entry", options.entry, all.entries)(_.name)
      folder  <- Expect.optional(options.out)(OutFolder.made("--out", _))
      set = all
        .copy(
          tasks =
            if options.task.nonEmpty then tasks ++ own
            else if own.nonEmpty then own.toVector
            else all.tasksOf(summon[Scenarios]),
          entries = entries
        )
        .flownBy(options.policy)
      benchmark = Benchmark(set, options.seeds)
      _ <- benchmark.mistake.map("--policy: " + _).toLeft(())
      _    = benchmark.notFlown.foreach(Console.err.println)
      line = ProgressLine(benchmark.flights, Console.err)
      rows <-
        var landed = 0L
        benchmark.fly: more =>
          landed += more
          line.show(landed, "flights")
      _        = line.end()
      sections = BenchmarkTables.of(rows)
      shown    = Shown(options.json.value)
      _        = shown.tables(sections, Section.text(sections))
      _ <- folder.fold(Right(())): folder =>
        OutFolder
          .write(
            folder,
            OutFolder.text("benchmark.json", Section.json(sections)) +:
              OutFolder.picture("benchmark", BenchmarkFigure(rows), "How far off the truth each entry is")
          )
          .map(files => shown.say(s"written: ${files.mkString(", ")}"))
      lost = rows.flatMap(_.notFlown).distinct
      _ <- Expect.that(lost.isEmpty)(lost.mkString("\n"))
    yield ()

  /** The entries with the given names, or all entries if no name is given. */
  private def chosen[A](option: String, names: Seq[String], all: Vector[A])(
      name: A => String
  ): Either[String, Vector[A]] =
    for _ <- Expect.all(names)(came =>
        Expect.that(all.exists(name(_) == came))(
          s"$option: expected ${all.map(name).mkString(", ")}, got '$came'"
        )
      )
    yield all.filter(each => names.isEmpty || names.contains(name(each)))

private object BenchmarkCommand:
  private val MostSeeds = 1000
