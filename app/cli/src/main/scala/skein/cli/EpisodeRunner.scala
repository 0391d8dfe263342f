package skein.cli

import java.nio.file.Path
import skein.gpu.GpuFailure
import skein.optimise.Evaluator
import skein.search.*

/** Evaluates a search's candidates in this process or by a cluster's workers, with identical bits. */
private[cli] trait EpisodeRunner:
  def apply(judge: Judge): Evaluator

  /** Reports progress while others compute and this thread waits.
    *
    * @param show called with the number of episodes that the current call has done, and a text
    */
  def onWait(show: (Long, String) => Unit): Unit

private[cli] object EpisodeRunner:

  private def here(ready: ReadySearch, threads: Int): EpisodeRunner = new EpisodeRunner:
    private val judges                             = ready.judges(threads)
    def apply(judge: Judge): Evaluator             = judges(judge)
    def onWait(show: (Long, String) => Unit): Unit = ()

  private def elsewhere(run: ClusterRun, blockEpisodes: Int): EpisodeRunner = new EpisodeRunner:
    private var show: (Long, String) => Unit       = (_, _) => ()
    def onWait(show: (Long, String) => Unit): Unit = this.show = show
    def apply(judge: Judge): Evaluator             =
      ClusterEvaluator(
        run,
        judge,
        blockEpisodes,
        episodes => show((episodes * run.share).toLong, run.status)
      )

  /** Runs `body` with the evaluators that the options choose, and stops them afterwards.
    *
    * @param program the class whose `main` starts the commands
    */
  def using(
      options: Option[ClusterOptions.Checked],
      program: String,
      ready: ReadySearch,
      folder: Path,
      threads: Int,
      shown: Shown
  )(body: EpisodeRunner => Either[String, Unit]): Either[String, Unit] = options match
    case None =>
      try body(here(ready, threads))
      catch case failed: (BlocksFailed | GpuFailure) => Left(failed.getMessage)
    case Some(asked) =>
      val posed = QuestionKind.Search.of(VerifiedQuestion.bytes(ready))
      ClusterRun.using(asked, program, posed, folder, threads, shown): run =>
        body(elsewhere(run, asked.block.getOrElse(ready.blockEpisodes)))
