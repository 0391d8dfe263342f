package skein.cli

import mainargs.{Flag, ParserForClass, arg}
import skein.report.{Section, TextTable}
import skein.settings.NamedScene
import skein.scenario.{Scenario, Scenarios}
import skein.torture.{FaultPlan, Torture, Verdict}
import skein.units.*

/** Options of `./skein torture`. */
final case class TortureOptions(
    @arg(doc = "flights to fly, one for each seed")
    seeds: Int = 100,
    @arg(doc = "the first seed")
    first: Long = 1,
    @arg(doc = "of each flight, for example 60s")
    duration: String = "60s",
    @arg(doc = "flights at once; without it, as many as there are cores")
    threads: Option[Int],
    @arg(doc =
      "whose task is flown (default: duels, several side by side, where there are any, else the first)"
    )
    scenario: Option[String],
    @arg(doc =
      "what stands in the world: empty, forest, pursuit, street, or a file; without it, what the scenario says"
    )
    scene: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

final class TortureCommand(using scenarios: Scenarios)
    extends OptionsCommand[TortureOptions](
      "torture",
      "flies teams in virtual time while everything goes wrong, and checks what must hold all the same",
      ParserForClass[TortureOptions]
    ):

  protected def execute(options: TortureOptions): Either[String, Unit] =
    for
      duration <- Span
        .parse(options.duration)
        .filterOrElse(
          _ >= FaultPlan.Shortest,
          s"expected ${FaultPlan.Shortest.toSeconds} s or more, came ${options.duration}"
        )
        .left
        .map(mistake => s"--duration: $mistake")
      threads = options.threads.getOrElse(Runtime.getRuntime.availableProcessors)
      _ <- Either.cond(options.seeds > 0 && threads > 0, (), "--seeds and --threads: expected 1 or more")
      shown = Shown(options.json.value)
      task <- scenarioOf(options.scenario)
      _    <- Either.cond(
        task.forall(_.eyes.isEmpty),
        (),
        s"--scenario ${options.scenario.getOrElse("")}: its policies know by cameras, which torture does not have"
      )
      scene <- options.scene.fold(Right(None))(NamedScene.read(_).map(Some(_)).left.map("--scene: " + _))
      failed = fly(options, duration, threads, task, scene, shown)
      _      = if options.json.value then shown.tables(Seq(broken(failed)), "")
      _ <- Either.cond(failed.isEmpty, (), s"${failed.size} of ${options.seeds} flights broke a rule")
    yield ()

  /** Absent where duels are flown, as many as the seed says. */
  private def scenarioOf(named: Option[String]): Either[String, Option[Scenario]] = named match
    case Some(name) => scenarios.kind(name).left.map("--scenario: " + _).map(kind => Some(kind.standard))
    case None       => Right(scenarios.firstWithoutDuel.map(_ => scenarios.kinds.head.standard))

  /** A row for each rule that a flight broke. */
  private def broken(failed: Vector[Verdict]): Section = Section(
    "Broken rules",
    table = Some(
      TextTable(
        Vector("seed", "<violation"),
        for
          verdict <- failed
          line    <- verdict.violations.toVector
        yield Vector(verdict.faultPlan.seed.toString, line)
      )
    )
  )

  private def fly(
      options: TortureOptions,
      duration: Span,
      threads: Int,
      task: Option[Scenario],
      scene: Option[NamedScene],
      shown: Shown
  ): Vector[Verdict] =
    val startedAt = System.nanoTime()
    var flown     = 0
    var shownAt   = startedAt
    var failed    = Vector.empty[Verdict]

    def show(): Unit =
      val seconds = (System.nanoTime() - startedAt) * 1e-9
      val speed   = flown * duration.toSeconds / seconds
      Console.err.println(
        f"$flown of ${options.seeds} flights of ${options.duration}, ${failed.size} failed, $seconds%.0f s, $speed%.0f times real time"
      )

    Edge.tellingIfCut(s"$flown of ${options.seeds} flights have landed, ${failed.size} failed"):
      Torture.all(Iterator.range(0, options.seeds).map(options.first + _), duration, threads, task, scene):
        verdict =>
          flown += 1
          if !verdict.isClean then
            failed :+= verdict
            shown.say(verdict.faultPlan.toString)
            verdict.violations.foreach(line => shown.say(s"  $line"))
            shown.say(
              s"  again: ./skein torture --first ${verdict.faultPlan.seed} --seeds 1 --duration ${options.duration}${options.scenario.fold(
                  ""
                )(name => s" --scenario $name")}${options.scene.fold("")(name => s" --scene $name")}"
            )
          if System.nanoTime() - shownAt > 10_000_000_000L then
            shownAt = System.nanoTime()
            show()
    show()
    failed
