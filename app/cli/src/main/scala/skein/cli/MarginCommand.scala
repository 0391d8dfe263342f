package skein.cli

import java.nio.file.Path
import mainargs.{Flag, ParserForClass, arg}
import skein.airsim.{Vehicles, WorldSettings}
import skein.budget.Tolerance
import skein.margin.*
import skein.report.{Paragraph, Section}
import skein.scenario.{Scenario, Scenarios}
import skein.settings.{NamedScene, ScenarioSettings}
import skein.signal.LatencyProfile
import skein.units.Decimals.brief
import skein.units.{Clock, Expect, Span}

/** Command-line options of `./skein margin`, with their help texts. */
final case class MarginOptions(
    @arg(doc =
      "the scenario whose vehicles, world, limits and measures it flies by; " +
        "the command scenarios lists them"
    )
    scenario: Option[String],
    @arg(doc = "a setting of the scenario, for example vehicles=8; can be repeated")
    set: Seq[String],
    @arg(doc = "instead of a scenario, an AirSim settings.json with the vehicles")
    settings: Option[String],
    @arg(doc = "scene: empty, forest, pursuit, street, or a file (default: the scenario's, or empty)")
    scene: Option[String],
    @arg(doc =
      "what is judged: a measure of the scenario (default: its first), separation, distance (between the " +
        "first two vehicles), distance:NORTH,EAST,DOWN (of the first one from there), contacts, or printed: " +
        "the number that is the program's last line"
    )
    judge: Option[String],
    @arg(doc = "a link to fly over: direct, vpn, constant:100ms, …; can be repeated")
    link: Seq[String],
    @arg(doc =
      "constant round trips to fly over: FROM..TO/COUNT (default, without --link: 50ms..200ms/4)"
    )
    delays: Option[String],
    @arg(doc = "runs over each link")
    repeats: Int = 3,
    @arg(doc = "most time for a run, after which the program is stopped")
    seconds: Int = 60,
    @arg(doc = "time after the program's first command that is not judged, such as its way to a start")
    skip: String = "0s",
    @arg(doc = "tolerance, in per cent of the result without a link (default: 5)")
    tolerance: Option[Double],
    @arg(doc = "instead of --tolerance, the tolerance in the measure's unit")
    within: Option[Double],
    @arg(
      name = "at-once",
      doc = "runs at once, each with a simulator and a program (default: one for each two cores)"
    )
    atOnce: Option[Int],
    @arg(doc = "seed of every random choice")
    seed: Long = 1,
    @arg(doc =
      "folder for margin.svg, margin.png, margin.json, and programs.txt with what the program printed"
    )
    out: String = "margin",
    @arg(doc = Shown.Doc)
    json: Flag,
    @arg(doc =
      "the program and its arguments, behind --: {port} in them, and the environment's SKEIN_PORT, is " +
        "the port of its simulator on this machine"
    )
    command: Behind
)

/** `./skein margin`: measures the delay margin of any program that flies vehicles by AirSim's interface. */
final class MarginCommand(using scenarios: Scenarios)
    extends Command[MarginOptions](
      "margin",
      "says how much latency any AirSim program tolerates, by running it over one link after the other",
      ParserForClass[MarginOptions]
    ):
  import MarginCommand.*

  override protected def check(options: MarginOptions): Either[String, Unit] = asked(options).map(_ => ())

  private final case class Asked(
      task: MarginTask,
      links: Vector[LatencyProfile],
      tolerance: Tolerance,
      atOnce: Int
  )

  private def asked(options: MarginOptions): Either[String, Asked] =
    val command = options.command.words
    for
      _ <- Expect.that(command.nonEmpty)("expected a program behind --, for example -- python my.py {port}")
      scenario <- scenarioOf(options)
      world    <- worldOf(options, scenario)
      scene    <- NamedScene.read(options.scene.orElse(scenario.map(_.scene)).getOrElse("empty")).left
        .map("--scene: " + _)
      judge <- MarginJudge.read(options.judge, scenario, world.vehicles.size).left.map("--judge: " + _)
      links <- linksOf(options)
      _     <- Expect.within("--repeats", options.repeats, 1, 100)
      _     <- Expect.within("--seconds", options.seconds, 1, 3600)
      skip  <- Span.parse(options.skip).left.map("--skip: " + _)
      _     <- Expect.that(skip.toSeconds < options.seconds)(
        s"--skip: expected less than the ${options.seconds} s of --seconds, got '${options.skip}'"
      )
      tolerance <- Tolerance.read(options.tolerance, options.within)
      _         <- Expect.within("--at-once", options.atOnce.getOrElse(1), 1, 64)
    yield Asked(
      MarginTask(command, world, scene.scene, scenario, judge, Span.ofSeconds(options.seconds), skip),
      links,
      tolerance,
      options.atOnce.getOrElse((Runtime.getRuntime.availableProcessors / 2).max(1))
    )

  private def scenarioOf(options: MarginOptions): Either[String, Option[Scenario]] = options.scenario match
    case None =>
      Expect.that(options.set.isEmpty)("--set: expected with --scenario, whose settings they are")
        .map(_ => None)
    case Some(name) =>
      for
        _        <- Expect.that(options.settings.isEmpty)("--settings: expected without --scenario")
        kind     <- scenarios.kind(name).left.map("--scenario: " + _)
        set      <- Arguments.settings(options.set)
        scenario <- ScenarioSettings.ofKeys(kind, set.toMap).left.map("--set: " + _)
      yield Some(scenario)

  private def worldOf(options: MarginOptions, scenario: Option[Scenario]): Either[String, WorldSettings] =
    (scenario, options.settings) match
      case (Some(flown), _) =>
        val vehicles = flown.agents.map(Vehicles.settings)
        Right(WorldSettings.of(vehicles, flown.equipment))
      case (None, Some(file)) => ServeCommand.fileOf(file).map(_.world).left.map("--settings: " + _)
      case _                  => Right(WorldSettings.Default)

  private def linksOf(options: MarginOptions): Either[String, Vector[LatencyProfile]] =
    for
      links  <- Expect.all(options.link)(Arguments.latency(_).left.map("--link: " + _))
      delays <- options.delays.orElse(Option.when(options.link.isEmpty)(UsualDelays)).toVector match
        case Vector(text) => MarginDelays.read(text).left.map("--delays: " + _)
        case _            => Right(Vector.empty)
      all = (links ++ delays).toVector
      _ <- Expect.that(all.distinct.size == all.size)(
        s"--link, --delays: expected each link once, got '${all.diff(all.distinct).head.name}' twice"
      )
      _ <-
        Expect.that(all.size <= MostLinks)(s"--link, --delays: expected $MostLinks at most, got ${all.size}")
      // Every margin is compared with none.
      others = all.filterNot(_ == LatencyProfile.none)
      _ <- Expect.that(others.nonEmpty)("--link: expected one with latency, got none alone")
    yield others

  protected def execute(options: MarginOptions): Either[String, Unit] =
    for
      asked  <- asked(options)
      folder <- OutFolder.made("--out", options.out)
      _      <- OutFolder.alone(folder)(fly(asked, options, folder))
    yield ()

  private def fly(asked: Asked, options: MarginOptions, folder: Path): Either[String, Unit] =
    Edge.withSystem("skein"):
      val shown = Shown(options.json.value)
      val count = (asked.links.size + 1) * options.repeats
      val most  = count.toLong * options.seconds / asked.atOnce
      shown.say(
        s"$count runs of up to ${options.seconds} s, ${MarginTables.atOnce(asked.atOnce)}: " +
          s"up to ${(most / 60.0).brief} min"
      )
      val trial = MarginTrial(asked.task, Clock.system)
      trial.warmUp()
      @volatile var stopped = false
      val runs              = MarginRuns(
        trial.run(_, _, () => stopped),
        asked.task.judge,
        options.repeats,
        asked.atOnce,
        options.seed,
        () => stopped,
        Console.err.println
      )
      for
        flown <- Edge.untilInterrupted(() => stopped = true)(runs.fly(LatencyProfile.none +: asked.links))
        _     <- OutFolder.write(folder, Vector(OutFolder.text("programs.txt", printed(flown))))
        curve <-
          MarginCurve.of(asked.task.judge, asked.tolerance, flown.points.head, flown.points.tail)
        sections  = MarginTables.of(curve, asked.task.scenario.exists(_.limits.nonEmpty))
        sentences = curve.sentence.capitalize +: MarginTables.remarks(curve, asked.atOnce)
        _         = shown.tables(
          sections,
          (Section.text(sections) +: sentences.map(Paragraph.lines(_, 100).mkString("\n"))).mkString("\n\n")
        )
        files <- OutFolder.write(
          folder,
          OutFolder.picture("margin", MarginFigure(curve), "delay margin") :+
            OutFolder.text("margin.json", Section.json(sections))
        )
        _ = shown.say(s"written: ${files.mkString(", ")}")
        _ <- Expect.that(!stopped)("stopped before all runs had ended; what was flown is printed")
      yield ()

  private def printed(flown: MarginRuns.Flown): String =
    flown.printed.map((link, run, text) => s"== $link, run $run\n$text\n").mkString

private object MarginCommand:
  private val UsualDelays = "50ms..200ms/4"
  private val MostLinks   = 100
