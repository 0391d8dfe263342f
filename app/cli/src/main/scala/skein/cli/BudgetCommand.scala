package skein.cli

import java.nio.file.{Files, Path}
import mainargs.{Flag, ParserForClass, arg}
import scala.util.Try
import skein.blocks.Ledger
import skein.budget.*
import skein.record.LoopKind
import skein.scenario.Scenarios
import skein.search.TeamQuestion
import skein.settings.{PolicyFile, ScenarioSettings}
import skein.signal.LatencyDistribution
import skein.units.Decimals.significant
import skein.units.{Expect, Span}

/** Command-line options of `./skein budget`, with their help texts. */
final case class BudgetOptions(
    @arg(doc = "a policy file, or the name of a family (default: paper-pursuer)")
    policy: Option[String],
    @arg(doc =
      "judges this scenario, by --objective, a sum of its measures " +
        "(default: its first), instead of a duel's policy"
    )
    scenario: Option[String],
    @arg(doc = "a setting of the scenario, for example vehicles=8; can be repeated")
    set: Seq[String],
    forward: ForwardOptions,
    @arg(doc = "time between decisions for one vehicle; each of several gets a map (default: 100ms)")
    period: Seq[String],
    @arg(name = "most-mean", doc = "upper end of the map's mean latencies (default: 200ms of a round trip)")
    mostMean: Option[String],
    @arg(name = "most-jitter", doc = "upper end of the map's jitters (default: 100ms of a round trip)")
    mostJitter: Option[String],
    @arg(doc = "cells along the latency (default: 40; of a scenario 10)")
    means: Option[Int],
    @arg(doc = "cells along the jitter (default: 20; of a scenario 5)")
    jitters: Option[Int],
    @arg(doc =
      "episodes of each cell (default: 1000 for a reduced model with SIMD, fewer where an episode costs more)"
    )
    episodes: Option[Int],
    @arg(doc = "tolerance, in per cent of the truth (default: 5)")
    tolerance: Option[Double],
    @arg(doc =
      "instead of --tolerance, the tolerance in the objective's unit"
    )
    within: Option[Double],
    @arg(name = "at-jitter", doc = "jitter at which the tolerated mean latency is printed (default: 20ms)")
    atJitter: Option[String],
    @arg(name = "one-way", doc = "all latencies are of one direction, instead of round trips")
    oneWay: Flag,
    @arg(doc = "folder for map.svg, map.png, map.csv and map.json")
    out: String = "budget",
    cluster: ClusterOptions,
    @arg(doc = "the map as JSON on standard output, as in map.json; everything else goes to standard error")
    json: Flag
)

/** @param program the class whose `main` starts the commands
  */
final class BudgetCommand(program: String)(using scenarios: Scenarios)
    extends Command[BudgetOptions](
      "budget",
      "says how much latency and jitter a policy or a scenario tolerates, and draws a map",
      ParserForClass[BudgetOptions]
    ):
  private val MostCells    = 10_000
  private val MostEpisodes = 100_000

  override protected def check(options: BudgetOptions): Either[String, Unit] =
    question(options, BudgetCommand.Period).map(_ => ())

  protected def execute(options: BudgetOptions): Either[String, Unit] =
    val legs = if options.oneWay.value then Legs.OneWay else Legs.RoundTrip
    for
      tolerance  <- Tolerance.read(options.tolerance, options.within)
      atJitterMs <- milliseconds("--at-jitter", options.atJitter, 20, legs)
      axes       <- axesOf(options, legs)
      _          <- Expect.that(options.atJitter.isEmpty || atJitterMs <= axes.jittersMs.last):
        s"--at-jitter: expected what the map has, up to ${(axes.jittersMs.last / legs.perRoundTrip).significant(3)} ms"
      _       <- Expect.optional(options.episodes)(Expect.within("--episodes", _, 1, MostEpisodes))
      periods <- Expect.all(options.period)(Span.parse(_).left.map("--period: " + _))
        .map(periods => if periods.isEmpty then Seq(BudgetCommand.Period) else periods)
      threads   <- options.forward.threadCount
      cluster   <- options.cluster.checked
      questions <- Expect.all(periods)(question(options, _)).map(_.toVector)
      subjects  <- Expect.all(questions)(_.subject(threads)).map(_.toVector)
      _         <- Expect.that(subjects.forall(_.task.loop != LoopKind.Paused.label)):
        "--loop: the paused loop is the truth and feels no latency; expected another"
      folder <- OutFolder.made("--out", options.out)
      _      <- OutFolder.alone(folder):
        for
          maps <- elsewhere(cluster, options, questions, subjects, folder, threads):
            fly(options, _, tolerance, axes, legs)
          isWhole = maps.size == subjects.size && maps.forall(_.budget.jittersMs == axes.jittersMs)
          // The next map in this folder may be of another question.
          _ =
            if isWhole && cluster.isDefined then Try(Files.deleteIfExists(folder.resolve(Ledger.Name))): Unit
          _ = tell(options, maps, atJitterMs)
          files <- write(maps, isWhole, atJitterMs, folder)
          _ = Shown(options.json.value).say(s"written: ${files.mkString(", ")}")
          _ <-
            Expect.that(isWhole)(
              s"${BudgetSubject.Stopped}; what was flown until then is printed and written"
            )
        yield ()
    yield ()

  private def tell(options: BudgetOptions, maps: Vector[BudgetMap], atJitterMs: Double): Unit =
    val shown = Shown(options.json.value)
    if options.json.value then Console.out.println(BudgetMap.json(maps, atJitterMs))
    for map <- maps do
      shown.say(s"${map.task.label}: ${map.sentence(atJitterMs)}")
      map.markLines.foreach(line => shown.say(s"  $line"))

  private def question(options: BudgetOptions, period: Span): Either[String, BudgetQuestion] =
    scenario(options).fold(duel(options, period))(team(options, _, period))

  private def scenario(options: BudgetOptions) = options.scenario.orElse(scenarios.firstWithoutGame)

  private def duel(options: BudgetOptions, period: Span): Either[String, BudgetQuestion] =
    import options.forward
    for
      _      <- Expect.that(options.set.isEmpty)("--set: expected with --scenario, whose settings they are")
      policy <- PolicyFile.named(options.policy.getOrElse("paper-pursuer"), None).left.map("--policy: " + _)
      other  <- forward.opponentOf(policy.role)
      named  <- forward.conditions(period)
    yield BudgetQuestion.OfDuel(
      PolicyFile.name(policy.role),
      policy.text,
      other.text,
      forward.objective.getOrElse("last10s"),
      named,
      forward.seed.getOrElse(1)
    )

  private def team(options: BudgetOptions, name: String, period: Span): Either[String, BudgetQuestion] =
    import options.forward
    for
      _          <- ForwardOptions.ofDuels("--policy" -> options.policy)(forward)
      kind       <- scenarios.kind(name).left.map("--scenario: " + _)
      set        <- Arguments.settings(options.set).map(_.toMap)
      scenario   <- ScenarioSettings.ofKeys(kind, set).left.map("--set: " + _)
      conditions <- forward.conditions(period, scenario.duration)
    yield BudgetQuestion.OfScenario(
      name,
      set,
      forward.objective,
      conditions.copy(plant = forward.plant.getOrElse(TeamQuestion.Plant)),
      plantIsTold = forward.plant.isDefined,
      forward.seed.getOrElse(1)
    )

  /** Chooses where the subject is simulated: in this process, or by the workers of the options. */
  private def elsewhere(
      cluster: Option[ClusterOptions.Checked],
      options: BudgetOptions,
      questions: Vector[BudgetQuestion],
      subjects: Vector[BudgetSubject],
      folder: Path,
      threads: Int
  )(fly: Vector[BudgetSubject] => Either[String, Vector[BudgetMap]]): Either[String, Vector[BudgetMap]] =
    cluster.fold(fly(subjects)): asked =>
      ClusterSubject
        .bytes(questions, subjects)
        .flatMap: question =>
          val shown = Shown(options.json.value)
          ClusterRun.using(asked, program, QuestionKind.Budget.of(question), folder, threads, shown): run =>
            fly(subjects.zipWithIndex.map((one, number) =>
              ClusterSubject(one, number, run, () => run.share, asked.block)
            ))

  private def milliseconds(option: String, text: Option[String], otherwise: Double, legs: Legs) =
    text
      .fold(Right(Span.ofMillis(otherwise)))(Span.parse)
      .map(_.toMillis * legs.perRoundTrip)
      .left
      .map(mistake => s"$option: $mistake")

  private def axesOf(options: BudgetOptions, legs: Legs): Either[String, BudgetAxes] =
    for
      mean   <- milliseconds("--most-mean", options.mostMean, 200 / legs.perRoundTrip, legs)
      jitter <- milliseconds("--most-jitter", options.mostJitter, 100 / legs.perRoundTrip, legs)
      (means, jitters) = scenario(options).fold((40, 20))(_ => (10, 5)) match
        case (means, jitters) => (options.means.getOrElse(means), options.jitters.getOrElse(jitters))
      _ <- Expect.that(means >= 2 && jitters >= 2 && means.toLong * jitters <= MostCells):
        s"--means, --jitters: expected 2 or more each and at most $MostCells cells, got $means and $jitters"
      _ <- Expect.that(mean > 0 && mean <= 500 && jitter > 0 && jitter <= 500):
        "--most-mean, --most-jitter: expected round trips of more " +
          s"than 0 and up to 500 ms, got $mean and $jitter ms"
    yield BudgetAxes.of(mean, means, jitter, jitters)

  private def fly(
      options: BudgetOptions,
      flown: Vector[BudgetSubject],
      tolerance: Tolerance,
      axes: BudgetAxes,
      legs: Legs
  ): Either[String, Vector[BudgetMap]] =
    val shown             = Shown(options.json.value)
    @volatile var stopped = false
    Edge.untilInterrupted(() => stopped = true):
      def mapOf(subject: BudgetSubject) =
        import subject.task
        val what  = s"${task.loop} every ${task.periodMs.significant(4)} ms"
        val sweep = BudgetSweep(subject, axes, tolerance, options.episodes)
        shown.say(
          s"$what, ${task.vehicles}\n" +
            s"${sweep.episodes} episodes of ${task.durationS.significant(4)} s in each of " +
            s"${sweep.expected / sweep.episodes} cells; engine: ${sweep.engine}"
        )
        val startedAt = System.nanoTime()
        val line      = ProgressLine(sweep.expected, Console.err)
        for
          budget <- sweep.map(line.show(_, ""), () => stopped)
          _ = line.end()
          _ = shown.say(
            f"${budget.cells.flatten.flatten.size.toLong * sweep.episodes}%,d episodes in ${(System.nanoTime() - startedAt) * 1e-9}%.1f s"
          )
          marks <-
            Expect.all(if stopped then Nil else BudgetCommand.Marked): (name, roundTrip) =>
              sweep.over(roundTrip).map(BudgetMark(name, roundTrip, _))
        yield BudgetMap(
          subject.task,
          sweep.engine,
          tolerance,
          sweep.episodes,
          budget,
          marks.toVector,
          legs
        )
      flown.foldLeft[Either[String, Vector[BudgetMap]]](Right(Vector.empty)): (before, subject) =>
        before.flatMap: maps =>
          if stopped && maps.nonEmpty then before
          else
            mapOf(subject) match
              case Left(BudgetSubject.Stopped) if maps.nonEmpty => before
              case one                                          => one.map(maps :+ _)

  /** Writes the maps. A partial map never replaces a whole one, and has no picture: it may have a single row.
    */
  private def write(
      maps: Vector[BudgetMap],
      isWhole: Boolean,
      atJitterMs: Double,
      folder: Path
  ): Either[String, Vector[Path]] =
    val csv  = (BudgetMap.CsvHeader +: maps.flatMap(_.csvRows)).mkString("", "\n", "\n")
    val name = if isWhole then "map" else "partial-map"
    OutFolder.write(
      folder,
      (if isWhole then OutFolder.picture(name, BudgetFigure(maps), "latency budget") else Vector.empty) :+
        OutFolder.text(s"$name.csv", csv) :+ OutFolder.text(s"$name.json", BudgetMap.json(maps, atJitterMs))
    )

private object BudgetCommand:
  private val Period = Span.ofMillis(100)
  private val Marked = Seq("direct" -> LatencyDistribution.Direct, "vpn" -> LatencyDistribution.Vpn)
