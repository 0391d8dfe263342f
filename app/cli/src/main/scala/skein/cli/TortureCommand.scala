package skein.cli

import java.nio.file.Path
import mainargs.{Flag, ParserForClass, arg}
import skein.report.{Section, TextTable, Typed}
import skein.scenario.Scenarios
import skein.settings.{NamedScene, ScenarioSettings}
import skein.torture.{FaultPlan, FaultVerdict}
import skein.units.*

/** Command-line options of `./skein torture`, with their help texts. */
final case class TortureOptions(
    @arg(doc = "flights to fly, one for each seed")
    seeds: Int = 100,
    @arg(doc = "the first seed")
    first: Long = 1,
    @arg(doc = "length of each flight, for example 60s")
    duration: String = "60s",
    @arg(doc = "flights at once; without it, as many as there are cores")
    threads: Option[Int],
    @arg(doc =
      "the scenario to fly (default: duels, several side by side, where there are any, else the first)"
    )
    scenario: Option[String],
    @arg(doc =
      "scene: empty, forest, pursuit, street, or a file; without it, the scenario's"
    )
    scene: Option[String],
    cluster: ClusterOptions,
    @arg(doc =
      "folder for what workers computed and their logs; the same command with the " +
        "same folder goes on where it was stopped (default: torture/DATE-TIME)"
    )
    out: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

/** @param program the class whose `main` starts the commands
  */
final class TortureCommand(program: String)(using scenarios: Scenarios)
    extends Command[TortureOptions](
      "torture",
      "flies teams in virtual time through injected faults, and checks ages, order and completeness of each flight",
      ParserForClass[TortureOptions]
    ):
  import TortureCommand.*

  /** The path is printed for flights that broke a rule. */
  override protected def readsScenario: Boolean = false

  protected def execute(options: TortureOptions): Either[String, Unit] =
    for
      duration <- Span
        .parse(options.duration)
        .filterOrElse(
          _ >= FaultPlan.Shortest,
          s"expected ${FaultPlan.Shortest.toSeconds} s or more, got ${options.duration}"
        )
        .left
        .map(mistake => s"--duration: $mistake")
      threads <- ForwardOptions.threadCount(options.threads)
      _       <- Expect.that(options.seeds > 0)(s"--seeds: expected 1 or more, got ${options.seeds}")
      mostFirst = Long.MaxValue - options.seeds + 1
      _ <- Expect.that(options.first <= mostFirst):
        s"--first: expected up to $mostFirst, since the other seeds follow it, got ${options.first}"
      cluster <- options.cluster.checked
      _       <- Expect.that(cluster.flatMap(_.block).forall(_ <= TortureQuestion.MostSeeds)):
        s"--block: expected 1 to ${TortureQuestion.MostSeeds} " +
          s"flights, got ${options.cluster.block.getOrElse(0)}"
      _ <- Expect.that(cluster.isEmpty || options.seeds <= TortureCommand.MostElsewhere):
        s"--seeds: expected 1 to ${TortureCommand.MostElsewhere} with --workers or --cluster, " +
          s"got ${options.seeds}"
      _ <- Expect.that(cluster.isDefined || options.out.isEmpty):
        "--out: expected with --workers or --cluster, for what they computed"
      shown = Shown(options.json.value)
      scene <- Expect.optional(options.scene)(NamedScene.read(_).left.map("--scene: " + _))
      named <- Expect.each(options.scenario)(ScenarioSettings.named).left.map("--scenario: " + _)
      task     = named.headOption.orElse(scenarios.firstWithoutGame.map(_ => scenarios.kinds.head.name))
      question = TortureQuestion.of(duration, task, scene)
      ready <- question.ready
      count = Count(options, duration, shown)
      _ <- cluster match
        case None =>
          val seeds = Iterator.range(0, options.seeds).map(options.first + _)
          Right(count.tellingIfCut(ready.fly(seeds, threads)(count.add)))
        case Some(asked) =>
          for
            folder <- OutFolder.made("--out", options.out.getOrElse(OutFolder.dated("torture")))
            _      <- OutFolder.alone(folder):
              val posed = QuestionKind.Torture.of(question.bytes)
              ClusterRun.using(asked, program, posed, folder, threads, shown):
                elsewhere(_, ready, options, asked, count)
          yield ()
      _      = count.end()
      failed = count.failed
      _ <- Expect.that(failed.isEmpty)(s"${failed.size} of ${options.seeds} flights broke a rule")
    yield ()

  private def elsewhere(
      run: ClusterRun,
      ready: TortureQuestion.Ready,
      options: TortureOptions,
      asked: ClusterOptions.Checked,
      count: Count
  ): Either[String, Unit] =
    val blocks = ready.blocks(options.first, options.seeds, asked.block.getOrElse(BlockFlights))
    count
      .tellingIfCut:
        run.computed(blocks, onAnswer = ready.verdicts(_).foreach(count.add))(())
      .flatMap(_.toRight("no worker is left").map(_ => ()))

object TortureCommand:
  /** Maximum number of seeds with workers: all blocks are listed in advance. */
  private val MostElsewhere = 1_000_000

  /** Flights in a block: about half a second of one core. */
  private val BlockFlights = 2
  private val ShowNanos    = 10_000_000_000L

  /** The command that repeats a flight, as a person is to type it. */
  private[cli] def again(options: TortureOptions, seed: Long): String =
    def typed(option: String, name: Option[String]) =
      name.fold("")(word => s" $option ${Typed.path(Path.of(word))}")
    s"./skein torture --first $seed --seeds 1 --duration ${Typed.word(options.duration)}" +
      typed("--scenario", options.scenario) + typed("--scene", options.scene)

  /** Counts flights as they end, and prints progress. */
  private final class Count(options: TortureOptions, duration: Span, shown: Shown):
    private val startedAt = System.nanoTime()
    private var flown     = 0
    private var shownAt   = startedAt
    private var broken    = Vector.empty[FaultVerdict]

    def failed: Vector[FaultVerdict] = broken

    def tellingIfCut[A](body: => A): A =
      Edge.tellingIfCut(s"$flown of ${options.seeds} flights have ended, ${failed.size} failed")(body)

    def add(verdict: FaultVerdict): Unit =
      flown += 1
      if !verdict.isClean then
        broken :+= verdict
        shown.say(verdict.faultPlan.toString)
        verdict.violations.foreach(line => shown.say(s"  $line"))
        shown.say(s"  again: ${again(options, verdict.faultPlan.seed)}")
      if System.nanoTime() - shownAt > ShowNanos then
        shownAt = System.nanoTime()
        show()

    def end(): Unit =
      show()
      if options.json.value then shown.tables(Seq(table), "")

    private def show(): Unit =
      val seconds = (System.nanoTime() - startedAt) * 1e-9
      val speed   = flown * duration.toSeconds / seconds
      Console.err.println(
        f"$flown of ${options.seeds} flights of ${options.duration}, " +
          f"${failed.size} failed, $seconds%.0f s, $speed%.0f times real time"
      )

    /** A table with a row for each rule that a flight broke. */
    private def table: Section = Section(
      "Broken rules",
      table = Some(
        TextTable(
          Vector("seed", "<violation"),
          for
            verdict <- failed
            line    <- verdict.violations
          yield Vector(verdict.faultPlan.seed.toString, line)
        )
      )
    )
