package skein.cli

import java.nio.file.Path
import skein.lanes.TeamBatch
import skein.optimise.SearchState
import skein.search.*
import skein.settings.PolicyFile.brief
import skein.view.TaskShow

/** `./skein search --scenario`: a search over a scenario's settings, to its end or until it is stopped. */
private[cli] final class TeamSearch(
    setup: TeamSetup,
    folder: Path,
    threads: Int,
    fliers: Fliers,
    shown: Shown,
    task: TaskShow
):
  import TeamSearch.*

  private val measured = setup.formula + (if setup.unit.isEmpty then "" else s", ${setup.unit}")
  private val onShow   = SearchOnShow(
    task,
    s"${setup.kind.name}, ${setup.question.conditions.loop} over ${setup.question.link}",
    setup.search.expected,
    measured
  )

  def run(from: SearchState): Either[String, Unit] =
    val batch = setup.batch(threads)
    say(introduction(batch))
    @volatile var stopped = false
    Edge.untilInterrupted(() => stopped = true):
      val startedAt = System.nanoTime()
      val line      = ProgressLine(setup.search.expected, Console.err, from.flown)
      var last      = from
      fliers.onWait((flying, how) => line.show(last.flown + flying, s"$how; ${progress(last)}"))
      val searched =
        SearchRun(setup.search, setup.question, fliers(Judge.Candidates), folder, () => System.nanoTime())
          .run(from, () => stopped): state =>
            last = state
            line.show(state.flown, progress(state))
            onShow.step(state, progress(state))
      line.end()
      fliers.onWait((_, _) => ())
      searched.flatMap: state =>
        val seconds = (System.nanoTime() - startedAt) * 1e-9
        val flown   = state.flown - from.flown
        say(
          f"$flown%,d episodes of ${setup.conditions.duel.durationS}%.0f s flown in $seconds%.1f s, ${flown / seconds.max(1e-3)}%,.0f a second"
        )
        val goOn = s"stopped; ./skein search --resume $folder goes on"
        if state.best.isEmpty then Right(shown.tables(Nil, goOn))
        else conclude(batch, state).map(_ => if !state.isDone then say(goOn))

  private def introduction(batch: TeamBatch): String =
    import setup.question
    val axes =
      setup.space.axes.map(axis => s"${axis.name} ${brief(axis.least)} … ${brief(axis.most)}").mkString(", ")
    val team = setup.scenario(setup.space.defaults)
    s"""${setup.text}: ${setup.kind.name} of ${team.agents.size} ($axes)
       |loop ${question.conditions.loop} every ${brief(
        question.conditions.periodMs
      )} ms over ${question.link}; ${setup.conditions.vehicle.description}
       |${question.method}, about ${setup.search.expected} episodes; engine: ${setup.engine(
        batch
      )}""".stripMargin

  private def progress(state: SearchState): String =
    state.best.fold("no candidate measured yet"): best =>
      val settings =
        setup.space.axes.zip(best.candidate).map((axis, value) => s"${axis.name} ${brief(value)}")
      s"best ${brief(best.tally.mean)} ${setup.unit} with ${settings.mkString(", ")}"

  /** Measures the winner on fresh episodes and writes settings and pictures. */
  private def conclude(batch: TeamBatch, state: SearchState): Either[String, Unit] =
    val fresh  = if state.isDone then setup.question.fresh else setup.question.fresh.min(FreshEpisodes)
    val result = TeamSearchResult.measured(setup, fliers(_), state, fresh)
    for
      file <- OutFolder.write(folder, Seq(OutFolder.text("scenario.conf", result.file)))
      _ = shown.tables(Seq(result.section), lines(result.summary))
      pictures <- if state.isDone then landscape(batch, result) else Right(Vector.empty)
    yield say(s"written: ${(file ++ pictures).mkString(", ")}")

  private def landscape(batch: TeamBatch, result: TeamSearchResult): Either[String, Vector[Path]] =
    say("drawing the landscape")
    val byLanes = setup.fliesByLanes(batch)
    val land    = Landscape.of(
      setup.space,
      result.best,
      fliers(Judge.Candidates),
      SearchResult.FreshFrom until SearchResult.FreshFrom + (if byLanes then LandscapeEpisodes else 2),
      onMap = if byLanes then OnMap else ScalarOnMap,
      onRow = onShow.landscape
    )
    val title =
      s"${setup.kind.name}, ${setup.question.conditions.loop} over ${setup.question.link}, model ${setup.conditions.vehicle.name}"
    val drawing = LandscapeFigure(land, title, measured)
    OutFolder.write(
      folder,
      OutFolder.picture("landscape", drawing, title) :+ OutFolder.text("landscape.csv", land.csv)
    )

  private def say(text: String): Unit = shown.say(lines(text))

  private def lines(text: String): String = text.linesIterator.map(_.stripTrailing).mkString("\n")

private[cli] object TeamSearch:
  /** Each needs a timetable of its own, which is made by the scalar engine. */
  val FreshEpisodes             = 256
  private val LandscapeEpisodes = 16
  private val OnMap             = 21
  private val ScalarOnMap       = 7
