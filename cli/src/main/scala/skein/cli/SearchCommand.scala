package skein.cli

import java.nio.file.{Files, Path}
import java.time.LocalDateTime
import java.time.format.DateTimeFormatter
import mainargs.{Flag, ParserForClass, arg}
import skein.lanes.DuelBatch
import skein.optimise.{CmaEs, SearchState}
import skein.policy.PolicyFamily
import skein.scenario.Scenarios
import skein.search.*
import skein.settings.PolicyFile
import skein.simd.LaneFunction
import skein.units.Span
import skein.view.{Shows, TaskShow}

/** Options of `./skein search`. */
final case class SearchOptions(
    @arg(doc = "of the policies to choose from (default: paper-pursuer)")
    family: Option[String],
    @arg(doc = "pursuer or evader, for families that suit both")
    role: Option[String],
    @arg(doc = "grid, random, cross-entropy, cma-es or racing (default: cma-es)")
    method: Option[String],
    @arg(doc = "the latency profile: none, direct, vpn, constant:200ms, … (default: vpn)")
    link: Option[String],
    @arg(doc = "between decisions for one vehicle (default: 100ms)")
    period: Option[String],
    @arg(doc = "to try in all (default: 1000)")
    candidates: Option[Int],
    @arg(doc = "that each candidate flies; when racing, in the first round (default: 20)")
    episodes: Option[Int],
    @arg(doc = "of a generation of cma-es and cross-entropy (default: 40, or more for many parameters)")
    population: Option[Int],
    @arg(doc =
      "fresh episodes on which the winner is measured (default: 4096 with a reduced model by SIMD, fewer where an episode costs more); no point of the landscape takes more"
    )
    fresh: Option[Int],
    @arg(doc =
      "searches settings of this scenario, a team's, in the place of a duel's policy; the command scenarios lists them"
    )
    scenario: Option[String],
    @arg(doc = "NAME=VALUE: a setting of the scenario, for example vehicles=8; may be given several times")
    set: Seq[String],
    @arg(doc = "NAME=LOW..HIGH: a setting of the scenario to search; may be given several times")
    vary: Seq[String],
    forward: ForwardOptions,
    cluster: ClusterOptions,
    @arg(doc = "folder for state, policy and pictures; without it, searches/DATE-TIME")
    out: Option[String],
    @arg(doc = "a folder whose search was stopped: goes on with it, and ends as if it had not been stopped")
    resume: Option[String],
    view: ViewOptions,
    @arg(doc = Shown.Doc)
    json: Flag
)

/** @param program
  *   the class whose `main` starts the commands
  */
final class SearchCommand(program: String)(using scenarios: Scenarios)
    extends OptionsCommand[SearchOptions](
      "search",
      "looks for the best of many policies by forward simulation under a loop's real timing",
      ParserForClass[SearchOptions]
    ):

  protected def execute(options: SearchOptions): Either[String, Unit] =
    val shown = Shown(options.json.value)
    for
      threads <- options.forward.threadCount
      cluster <- options.cluster.checked
      begun   <- options.resume.fold(begin(options))(resume(options, _))
      (folder, question, state) = begun
      shows                     = Shows()
      task                      = TaskShow("search")
      _                         = shows.add(task)
      _ <- options.view.serving(shows):
        question match
          case duel: SearchQuestion =>
            duel.setup.flatMap: setup =>
              val block = Effort.blockEpisodes(setup.isFast(setup.batch(1)), setup.conditions.vehicle)
              Fliers.using(cluster, program, setup, duel, folder, threads, block, shown):
                run(setup, folder, state.getOrElse(setup.search.start), threads, _, shown, task)
          case team: TeamQuestion =>
            team.setup.flatMap: setup =>
              val block = Effort.blockEpisodes(setup.fliesByLanes(setup.batch(1)), setup.conditions.vehicle)
              Fliers.using(cluster, program, setup, team, folder, threads, block, shown):
                TeamSearch(setup, folder, threads, _, shown, task).run(state.getOrElse(setup.search.start))
    yield ()

  private type Begun = (Path, SearchQuestion | TeamQuestion, Option[SearchState])

  private def resume(options: SearchOptions, folder: String): Either[String, Begun] =
    import options.*
    val others =
      Seq(family, role, method, link, period, candidates, episodes, population, fresh, scenario, out)
    for
      _ <- Either.cond(
        others.forall(_.isEmpty) && set.isEmpty && vary.isEmpty && forward.isEmpty,
        (),
        "--resume: everything but --threads and who computes is taken from the folder; expected no other option"
      )
      file <- SearchFile.read(Path.of(folder)).left.map("--resume: " + _)
    yield (Path.of(folder), file.question, Some(file.state))

  private def begin(options: SearchOptions): Either[String, Begun] =
    val folder = Path.of(options.out.getOrElse(
      s"searches/${LocalDateTime.now().format(DateTimeFormatter.ofPattern("yyyy-MM-dd-HHmmss"))}"
    ))
    for
      question <- options.scenario.orElse(scenarios.firstWithoutDuel).fold(duel(options))(team(options, _))
      _        <- Either.cond(
        !Files.exists(folder.resolve(SearchFile.Name)),
        (),
        s"--out: $folder holds a search already; --resume $folder goes on with it"
      )
      _ <- OutFolder.made("--out", options.out.getOrElse(folder.toString))
    yield (folder, question, None)

  private def team(options: SearchOptions, scenario: String): Either[String, TeamQuestion] =
    import options.forward
    for
      _         <- ForwardOptions.ofDuels("--family" -> options.family, "--role" -> options.role)(forward)
      objective <- forward.objective.toRight(
        "--objective: expected with a scenario: a sum of its measures, for example off-ring"
      )
      period     <- Span.parse(options.period.getOrElse("100ms")).left.map("--period: " + _)
      conditions <- forward.conditions(period)
      set        <- Arguments.settings(options.set)
      vary       <- Arguments.all(options.vary)(Varied.parse(_).left.map("--vary: " + _))
      candidates = options.candidates.getOrElse(1000)
      question   = TeamQuestion(
        scenario,
        set.toMap,
        vary.toVector,
        objective,
        options.method.getOrElse("cma-es"),
        // Teams fly low, where the model of three parameters does not hold.
        conditions.copy(plant = forward.plant.getOrElse("drag")),
        options.link.getOrElse("vpn"),
        candidates,
        options.episodes.getOrElse(20),
        options.population.getOrElse(LaneFunction.COUNT.min(candidates.max(4))),
        forward.seed.getOrElse(1),
        options.fresh.getOrElse(TeamSearch.FreshEpisodes)
      )
      _ <- question.setup
    yield question

  private def duel(options: SearchOptions): Either[String, SearchQuestion] =
    import options.forward
    for
      _ <- Either.cond(
        options.set.isEmpty && options.vary.isEmpty,
        (),
        "--set, --vary: expected with --scenario, whose settings they are"
      )
      family     <- PolicyFamily.parse(options.family.getOrElse("paper-pursuer")).left.map("--family: " + _)
      role       <- PolicyFile.roleOf(family, options.role).left.map("--role: " + _)
      period     <- Span.parse(options.period.getOrElse("100ms")).left.map("--period: " + _)
      conditions <- forward.conditions(period)
      opponent   <- forward.opponentOf(role)
      candidates = options.candidates.getOrElse(1000)
      question   = SearchQuestion(
        family.name,
        PolicyFile.name(role),
        forward.objective.getOrElse("last10s"),
        options.method.getOrElse("cma-es"),
        conditions,
        options.link.getOrElse("vpn"),
        opponent.text,
        candidates,
        options.episodes.getOrElse(20),
        options.population.getOrElse(
          CmaEs.defaultPopulation(family.space.dimension).max(40).min(candidates.max(4))
        ),
        forward.seed.getOrElse(1),
        options.fresh
      )
      _ <- question.setup
    yield question

  private def run(
      setup: SearchSetup,
      folder: Path,
      from: SearchState,
      threads: Int,
      fliers: Fliers,
      shown: Shown,
      task: TaskShow
  ): Either[String, Unit] =
    val batch  = setup.batch(threads)
    val onShow = SearchOnShow(
      task,
      s"${setup.family.name}, ${setup.question.conditions.loop} over ${setup.question.link}",
      setup.search.expected,
      measured(setup)
    )
    say(shown, introduction(setup, batch))
    @volatile var stopped = false
    Edge.untilInterrupted(() => stopped = true):
      val startedAt = System.nanoTime()
      val line      = ProgressLine(setup.search.expected, Console.err, from.flown)
      var last      = from
      fliers.onWait((flying, how) => line.show(last.flown + flying, s"$how; ${progress(setup, last)}"))
      val searched =
        SearchRun(setup.search, setup.question, fliers(Judge.Candidates), folder, () => System.nanoTime())
          .run(from, () => stopped): state =>
            last = state
            line.show(state.flown, progress(setup, state))
            onShow.step(state, progress(setup, state))
      line.end()
      fliers.onWait((_, _) => ())
      searched.flatMap: state =>
        val seconds = (System.nanoTime() - startedAt) * 1e-9
        val flown   = state.flown - from.flown
        say(
          shown,
          f"$flown%,d episodes of ${setup.conditions.duration}%.0f s flown in $seconds%.1f s, ${flown / seconds.max(1e-3)}%,.0f a second"
        )
        val goOn = s"stopped; ./skein search --resume $folder goes on"
        if state.best.isEmpty then Right(shown.tables(Nil, goOn))
        else
          conclude(setup, batch, folder, state, fliers, shown, onShow).map(_ =>
            if !state.isDone then say(shown, goOn)
          )

  private def introduction(setup: SearchSetup, batch: DuelBatch): String =
    import setup.{family, objective, opponent, question}
    val axes =
      family.space.axes.take(4).map(axis => s"${axis.name} ${axis.least} … ${axis.most}").mkString(", ") +
        (if family.space.dimension > 4 then s" and ${family.space.dimension - 4} more" else "")
    s"""${objective.text}: ${question.role} ${family.name} ($axes) against ${opponent.label}
       |loop ${question.conditions.loop} every ${brief(
        question.conditions.periodMs
      )} ms over ${question.link}; ${setup.conditions.vehicle.description}
       |${question.method}, about ${setup.search.expected} episodes; engine: ${setup.engine(
        batch
      )}""".stripMargin

  private def progress(setup: SearchSetup, state: SearchState): String =
    state.best.fold("no candidate measured yet"): best =>
      s"best ${brief(best.tally.mean)} ${setup.objective.unit} with ${PolicyFile(setup.role, setup.family, best.candidate).label}"

  /** Measures the winner on fresh episodes and writes policy and pictures. */
  private def conclude(
      setup: SearchSetup,
      batch: DuelBatch,
      folder: Path,
      state: SearchState,
      fliers: Fliers,
      shown: Shown,
      onShow: SearchOnShow
  ): Either[String, Unit] =
    val effort = Effort.of(setup, batch)
    // Somebody who stops a search does not wait for long.
    val most   = if state.isDone then Int.MaxValue else effort.freshEpisodes
    val fresh  = setup.question.fresh.getOrElse(effort.freshEpisodes).min(most)
    val result = SearchResult.measured(setup, fliers(_), state, fresh)
    for
      file <- OutFolder.write(folder, Seq(OutFolder.text("policy.conf", result.file)))
      _ = shown.tables(Seq(result.section), lines(result.summary))
      pictures <-
        if state.isDone then landscape(setup, folder, result, effort.within(fresh), fliers, shown, onShow)
        else Right(Vector.empty)
    yield say(shown, s"written: ${(file ++ pictures).mkString(", ")}")

  private def landscape(
      setup: SearchSetup,
      folder: Path,
      result: SearchResult,
      effort: Effort,
      fliers: Fliers,
      shown: Shown,
      onShow: SearchOnShow
  ): Either[String, Vector[Path]] =
    say(shown, "drawing the landscape")
    val land = Landscape.of(
      setup.family.space,
      result.policy.parameters,
      fliers(Judge.Candidates),
      SearchResult.FreshFrom until SearchResult.FreshFrom + effort.landscapeEpisodes,
      onMap = effort.onMap,
      onRow = onShow.landscape
    )
    val title =
      s"${setup.family.name}, ${setup.question.conditions.loop} over ${setup.question.link}, model ${setup.conditions.vehicle.name}"
    val drawing = LandscapeFigure(land, title, measured(setup))
    OutFolder.write(
      folder,
      OutFolder.picture("landscape", drawing, title) :+ OutFolder.text("landscape.csv", land.csv)
    )

  private def measured(setup: SearchSetup): String =
    setup.objective.formula + (if setup.objective.unit.isEmpty then "" else s", ${setup.objective.unit}")

  private def brief(value: Double): String = PolicyFile.brief(value)

  private def say(shown: Shown, text: String): Unit = shown.say(lines(text))

  private def lines(text: String): String = text.linesIterator.map(_.stripTrailing).mkString("\n")

  extension (conditions: Conditions.Resolved) private def duration: Double = conditions.duel.durationS
