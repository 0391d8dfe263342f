package skein.cli

import java.nio.file.Path
import skein.optimise.SearchState
import skein.report.Typed
import skein.search.*
import skein.units.Decimals.significant

/** Runs a search in a terminal, to its end or until it is stopped. */
private[cli] final class SearchJob(
    ready: ReadySearch,
    folder: Path,
    threads: Int,
    runner: EpisodeRunner,
    shown: Shown
):
  import SearchJob.*

  private val probe = ready.probe

  /** Notes the engine of each candidate, to report those that did not use the expected one. */
  private val candidates = NotedEvaluator(runner(Judge.Candidates), ready.engine(_, Judge.Candidates))

  /** @param stored the search where it was stopped; without it, it begins */
  def run(stored: Option[SearchFile]): Either[String, Unit] =
    VerifiedQuestion
      .unchanged(stored.fold(Vector.empty)(_.probe), probe, "the search")
      .flatMap(_ => search(stored.fold(ready.search.start)(_.state)))

  private def search(from: SearchState): Either[String, Unit] =
    say(introduction)
    @volatile var stoppedAt = Option.empty[Long]
    def isStopped           = stoppedAt.isDefined
    def isLate              = stoppedAt.exists(System.nanoTime() - _ > PatienceNanos)
    Edge.untilInterrupted(() => stoppedAt = Some(System.nanoTime())):
      val startedAt = System.nanoTime()
      val line      = ProgressLine(ready.search.expected, Console.err, from.flown)
      var last      = from
      runner.onWait((flying, how) => line.show(last.flown + flying, s"$how; ${progress(last)}"))
      val searched =
        SearchRun(ready.search, ready.question, candidates, folder, () => System.nanoTime(), probe)
          .run(from, () => isStopped): state =>
            last = state
            line.show(state.flown, progress(state))
      line.end()
      runner.onWait((_, _) => ())
      searched.flatMap: state =>
        val seconds = (System.nanoTime() - startedAt) * 1e-9
        val flown   = state.flown - from.flown
        say(
          f"$flown%,d episodes of ${ready.durationS}%.0f s flown in " +
            f"$seconds%.1f s, ${flown / seconds.max(1e-3)}%,.0f a second"
        )
        candidates.others(ready.engine(ready.space.defaults, Judge.Candidates)).foreach(say)
        val goOn = s"stopped; ./skein search --resume ${Typed.path(folder)} goes on"
        if state.best.isEmpty then Right(shown.tables(Nil, goOn))
        else if !state.best.get.tally.mean.isFinite then
          Left(s"${ready.formula}: even the best candidate comes to no number; choose another objective")
        else conclude(state, () => isStopped, () => isLate).map(isWhole => if !isWhole then say(goOn))

  private def introduction: String =
    val shownAxes =
      ready.space.axes.take(MostAxes).map(axis =>
        s"${axis.name} ${axis.least.significant(4)} … ${axis.most.significant(4)}"
      )
    val more = ready.space.dimension - shownAxes.size
    val axes = shownAxes.mkString(", ") + (if more > 0 then s" and $more more" else "")
    s"""${ready.text}: ${ready.subject(axes)}
       |loop ${ready.under}, every ${ready.periodMs.significant(4)} ms; ${ready.vehicles}
       |${ready.method}, about ${numbered(
        ready.search.expected
      )} episodes; engine: ${ready.engines}${ready.rate(
        threads
      ).fold("")("; " + _)}""".stripMargin

  private def numbered(count: Long) = f"$count%,d"

  private def progress(state: SearchState): String =
    state.best.fold("no candidate measured yet"): best =>
      s"best ${best.tally.mean.significant(4)} ${ready.unit} with ${ready.label(best.candidate)}"

  /** Evaluates the winner on fresh episodes and writes it with pictures.
    *
    * @param isLate whether a user who stopped the search has waited long enough for the winner's measures
    * @return whether nothing is left to do
    */
  private def conclude(
      state: SearchState,
      isStopped: () => Boolean,
      isLate: () => Boolean
  ): Either[String, Boolean] =
    val effort = ready.effort
    // A user who stops a search does not wait for long.
    val most  = if state.isDone then Int.MaxValue else effort.freshEpisodes
    val fresh = ready.fresh.getOrElse(effort.freshEpisodes).min(most)
    say(f"measuring the best on $fresh%,d fresh episodes")
    SearchResult.measured(ready, runner(_), state, fresh, isLate) match
      case None =>
        say(s"${progress(state)}; it is not measured on fresh episodes, which would take a while")
        Right(false)
      case Some(found) => written(state, found, fresh, isStopped).map(_ => state.isDone)

  private def written(
      state: SearchState,
      found: Found,
      fresh: Int,
      isStopped: () => Boolean
  ): Either[String, Unit] =
    val result       = SearchResult(ready, found)
    val (name, text) = ready.file(found)
    for
      file <- OutFolder.write(folder, Seq(OutFolder.text(name, text)))
      _ = shown.tables(Seq(result.section), lines(result.summary))
      _ = found.doubt(ready.baseline, ready.search.direction).foreach(say)
      _ = SearchResult.atLimits(ready.space, found.best).foreach(say)
      _ = disagreement(found.best, fresh.min(SearchResult.Checked)).foreach(say)
      pictures <-
        if state.isDone then landscape(found.best, ready.effort.within(fresh), isStopped)
        else Right(Vector.empty)
    yield say(s"written: ${(file ++ pictures).mkString(", ")}")

  private def disagreement(best: Vector[Double], episodes: Int): Option[String] =
    val some = SearchResult.FreshFrom until SearchResult.FreshFrom + episodes
    for
      reference <- ready.reference(best, some)
      flown = runner(Judge.Winner).tallies(Vector(best), some).head
      told <- SearchResult.disagreement(flown, reference, ready.unit)
    yield told

  private def landscape(
      best: Vector[Double],
      effort: Effort,
      isStopped: () => Boolean
  ): Either[String, Vector[Path]] =
    say("drawing the landscape")
    val line = ProgressLine(effort.onMap, Console.err)
    val land = Landscape.of(
      ready.space,
      best,
      runner(Judge.Candidates),
      SearchResult.FreshFrom until SearchResult.FreshFrom + effort.landscapeEpisodes,
      isStopped,
      onCurve = effort.onCurve,
      onMap = effort.onMap,
      onRow = rows => line.show(rows.cells.size, "rows of the landscape")
    )
    line.end()
    land match
      case None =>
        say(s"stopped; ./skein search --resume ${Typed.path(folder)} draws the landscape")
        Right(Vector.empty)
      case Some(land) =>
        val title = s"${ready.title}, model ${ready.model}"
        OutFolder.write(
          folder,
          OutFolder.picture(
            "landscape",
            LandscapeFigure(land, title, ready.measure, ready.search.direction),
            title
          ) :+ OutFolder.text("landscape.csv", land.csv)
        )

  private def say(text: String): Unit = shown.say(lines(text))

  private def lines(text: String): String = text.linesIterator.map(_.stripTrailing).mkString("\n")

private[cli] object SearchJob:
  private val MostAxes = 4

  /** Maximum time for which a user who stopped a search waits for its result. */
  private val PatienceNanos = 2_000_000_000L
