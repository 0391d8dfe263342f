package skein.search

import java.nio.file.Path
import skein.optimise.{Evaluator, RunningStats, Search, SearchState}

/** Runs a search to its end, or until it is stopped, and keeps its state on disk: killing the process loses a
  * few seconds.
  *
  * @param probe [[ReadySearch.probe]], which a later program compares with its own
  */
final class SearchRun(
    search: Search,
    question: PosedSearch,
    evaluator: Evaluator,
    folder: Path,
    nanoTime: () => Long,
    probe: Vector[RunningStats] = Vector.empty
):
  import SearchRun.*

  private val files = NamedFiles.digests(question.named)

  /** @param isStopped checked from time to time, from any thread; true abandons the current step
    * @param onStep called with every state
    * @return the last state; Left says why it could not be stored
    */
  def run(
      from: SearchState,
      isStopped: () => Boolean
  )(onStep: SearchState => Unit): Either[String, SearchState] =
    var state                       = from
    var savedAt                     = nanoTime()
    var atMost                      = FirstStep
    var saved: Either[String, Unit] = save(state)
    while saved.isRight && !state.isDone && !isStopped() do
      val (before, flown) = (nanoTime(), state.flown)
      state = search.step(state, evaluator, atMost, isStopped)
      val now     = nanoTime()
      val perNano = (state.flown - flown).toDouble / (now - before).max(1)
      atMost = (perNano * StepNanos).toLong.max(1).min(MostAStep).toInt
      onStep(state)
      if now - savedAt > SaveNanos then
        saved = save(state)
        savedAt = nanoTime()
    saved.flatMap(_ => save(state)).map(_ => state)

  private def save(state: SearchState) =
    SearchFile.write(folder, SearchFile(SearchFile.Version, question, state, files, probe))

object SearchRun:
  private val FirstStep = 256
  private val MostAStep = 1_000_000L
  private val StepNanos = 500_000_000L
  private val SaveNanos = 2_000_000_000L
