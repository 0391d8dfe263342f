package skein.cli

import java.nio.file.Path
import java.security.MessageDigest
import java.util.concurrent.atomic.AtomicReference
import scala.collection.immutable.ArraySeq
import scala.concurrent.Future
import skein.blocks.Ledger
import skein.cluster.{CoordinatorNode, Progress, WorkerProcesses}
import skein.optimise.Evaluator
import skein.report.TextTable
import skein.search.*

/** Who flies a search's candidates: this process, or the workers of a cluster, with the same bits. */
private[cli] trait Fliers:
  def apply(judge: Judge): Evaluator

  /** Shows how it goes while others fly and this thread waits.
    *
    * @param show
    *   told how many episodes of the call under way are flown, and what to say
    */
  def onWait(show: (Long, String) => Unit): Unit

private[cli] object Fliers:

  /** This process. */
  def here(ready: ReadySearch, threads: Int): Fliers = new Fliers:
    private val judges                             = ready.judges(threads)
    def apply(judge: Judge): Evaluator             = judges(judge)
    def onWait(show: (Long, String) => Unit): Unit = ()

  /** Runs with those whom the options choose, and ends them.
    *
    * @param program
    *   the class whose `main` starts the commands
    * @param blockEpisodes
    *   of a block, unless told otherwise
    */
  def using(
      options: Option[ClusterOptions.Checked],
      program: String,
      ready: ReadySearch,
      question: SearchFile.Question,
      folder: Path,
      threads: Int,
      blockEpisodes: Int,
      shown: Shown
  )(body: Fliers => Either[String, Unit]): Either[String, Unit] = options match
    case None        => body(here(ready, threads))
    case Some(asked) =>
      val posed = PosedQuestion.bytes(question, ready)
      val name  = ArraySeq.unsafeWrapArray(MessageDigest.getInstance("SHA-256").digest(posed.toArray))
      for
        ledger <- Ledger.open(folder.resolve(Ledger.Name), name)
        ended  <-
          try
            CoordinatorNode
              .start(asked.listen, asked.tls, posed, ledger)(news => Console.err.println(news.text))
              .flatMap(node => Cluster(node, asked, program, folder, threads, blockEpisodes, shown).run(body))
          finally ledger.close()
      yield ended

  private final class Cluster(
      node: CoordinatorNode,
      options: ClusterOptions.Checked,
      program: String,
      folder: Path,
      threads: Int,
      blockEpisodes: Int,
      shown: Shown
  ) extends Fliers with Elsewhere:
    private val startedAt                    = System.nanoTime()
    private val failure                      = AtomicReference(Option.empty[String])
    private var show: (Long, String) => Unit = (_, _) => ()

    private val processes = WorkerProcesses(
      options.workers,
      WorkerProcesses.likeThis(
        program,
        Seq("worker", "--join", node.address.toString, "--attached", "--threads") :+
          (threads / options.workers.max(1)).max(1).toString
      ),
      number => folder.resolve(s"worker-$number.log"),
      node.ended,
      reason =>
        failure.set(Some(reason))
        node.cancel()
    )

    def run(body: Fliers => Either[String, Unit]): Either[String, Unit] =
      shown.say(s"workers join by ./skein worker --join ${node.address}")
      try
        processes.start()
        val done = body(this)
        shown.say(account)
        done
      catch case failed: ElsewhereFailed => Left(failed.getMessage)
      finally
        val closing = node.close()
        processes.close()
        Edge.await(closing)

    def apply(judge: Judge): Evaluator =
      ClusterEvaluator(
        this,
        judge,
        options.block.getOrElse(blockEpisodes),
        episodes =>
          val now = node.progress
          show(episodes * now.done / now.of.max(1), status(now))
      )

    def onWait(show: (Long, String) => Unit): Unit = this.show = show

    def compute(works: Vector[ArraySeq[Byte]]): Future[Either[String, Option[Vector[ArraySeq[Byte]]]]] =
      node.compute(works).map(outcome => outcome.flatMap(answers => failed(answers)))(using
        scala.concurrent.ExecutionContext.parasitic
      )

    /** A call that was cancelled since nobody is left has a reason. */
    private def failed[A](answers: Option[A]) =
      if answers.isDefined then Right(answers) else failure.get.toLeft(answers)

    def cancel(): Unit = node.cancel()

    private def seconds = (System.nanoTime() - startedAt) * 1e-9

    private def status(now: Progress): String =
      val counts = now.coordinator.counts
      val rate   = counts.accepted / seconds / now.here.max(1)
      f"${now.done} of ${now.of} blocks; ${now.here} workers, $rate%.2f blocks/s each; ${now.coordinator.workers.size} joined, ${now.died} lost"

    /** Who did how much. */
    private def account: String =
      val now    = node.progress
      val counts = now.coordinator.counts
      val rows   = now.coordinator.workers.toVector.sortBy((name, record) => (-record.accepted, name)).map:
        (name, record) =>
          Vector(
            name,
            record.cores.toString,
            record.accepted.toString,
            record.repeated.toString,
            f"${record.busyNanos * 1e-9}%.1f"
          )
      s"""${counts.accepted} blocks counted, ${now.resumed} more were in the ledger; ${counts.repeated} answers came twice, ${counts.lost} blocks were lost with their workers and given out again
         |${TextTable(
          Vector("<worker", "cores", "counted", "repeated", "busy, s"),
          rows.take(MostRows)
        ).render}${
          if rows.size > MostRows then s"\nand ${rows.size - MostRows} more" else ""
        }""".stripMargin

  private val MostRows = 40
