package skein.cli

import java.io.IOException
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.Path
import java.security.MessageDigest
import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicReference
import scala.collection.immutable.ArraySeq
import scala.concurrent.{ExecutionContext, Future}
import skein.blocks.Ledger
import skein.cluster.{BuildId, ClusterProgress, CoordinatorNode, WorkerProcesses}
import skein.link.Address
import skein.report.TextTable
import skein.search.{BlockExecutor, BlocksFailed}
import skein.units.Decimals

/** A coordinator for one question, with the workers that it started. */
private[cli] final class ClusterRun private (
    node: CoordinatorNode,
    options: ClusterOptions.Checked,
    program: String,
    folder: Path,
    threads: Int,
    shown: Shown
) extends BlockExecutor:
  private val failure = AtomicReference(Option.empty[String])

  /** Names of the workers of this machine whose processes have ended. */
  private val gone = ConcurrentHashMap.newKeySet[String]()

  /** When the first answers were received, and their number: before, workers are starting. */
  private var begun = Option.empty[(atNanos: Long, accepted: Long)]

  private val processes = WorkerProcesses(
    options.workers,
    WorkerProcesses.likeThis(program, ClusterRun.words(options, node.address, threads)),
    number => folder.resolve(s"worker-$number.log"),
    ended(_),
    failed(_)
  )

  private def ended(worker: String): Boolean =
    gone.add(worker): Unit
    node.ended(worker)
    node.progress.coordinator.workers.get(worker).exists(_.accepted > 0)

  private def failed(reason: String): Unit =
    if ClusterRun.isOtherHere(node.progress, gone.contains) then
      Console.err.println(s"$reason; goes on with the other workers")
    else
      failure.set(Some(reason))
      node.cancel()

  /** Starts workers only if the ledger lacks answers. */
  private def wanted(): Unit =
    val _ = Thread.ofVirtual().start: () =>
      try processes.start()
      catch case cannot: IOException => failed(s"cannot start workers: ${cannot.getMessage}")

  private def run[A](body: ClusterRun => Either[String, A]): Either[String, A] =
    shown.say(s"workers join by ./skein worker --join ${node.address}")
    try
      val done = body(this)
      shown.say(account)
      done
    catch case failed: BlocksFailed => Left(failed.getMessage)
    finally
      val closing = node.close()
      processes.close()
      Edge.await(closing)

  def compute(
      works: Vector[ArraySeq[Byte]],
      onAnswer: ArraySeq[Byte] => Unit
  ): Future[Either[String, Option[Vector[ArraySeq[Byte]]]]] =
    node
      .compute(works, onAnswer, () => wanted())
      .map(_.flatMap(answers => withReason(answers)))(using ExecutionContext.parasitic)

  /** Adds the reason to a call that was cancelled because no worker is left. */
  private def withReason[A](answers: Option[A]) =
    if answers.isDefined then Right(answers) else failure.get.toLeft(answers)

  def cancel(): Unit = node.cancel()

  /** The fraction of the current call that is done, 0 to 1. */
  def share: Double =
    val now = node.progress
    now.done.toDouble / now.of.max(1)

  /** Workers and progress of the current call, in a line. */
  def status: String =
    val now      = node.progress
    val nanos    = System.nanoTime()
    val accepted = now.coordinator.counts.accepted
    if begun.isEmpty && accepted > 0 then begun = Some((nanos, accepted))
    val rate = begun
      .filter(first => accepted > first.accepted)
      .fold("")(first =>
        ", " +
          f"${(accepted - first.accepted) * 1e9 / (nanos - first.atNanos) / now.here.max(1)}%.2f " +
          "blocks/s each"
      )
    val here = if now.here == 0 then "no worker is here" else Decimals.counted(now.here, "worker") + rate
    s"${now.done} of ${now.of} blocks; " +
      s"$here; ${now.coordinator.workers.size} joined, ${now.died} lost"

  /** Each worker's share of the work, in a line. */
  private def account: String =
    val now       = node.progress
    val counts    = now.coordinator.counts
    val isOneGone = now.coordinator.workers.values.exists(!_.isHere)
    val rows      = now.coordinator.workers.toVector.sortBy((name, record) => (-record.accepted, name)).map:
      (name, record) =>
        Vector(
          name,
          record.cores.toString,
          record.accepted.toString,
          f"${100.0 * record.accepted / counts.accepted.max(1)}%.0f %%",
          record.repeated.toString,
          f"${record.busyNanos * 1e-9}%.1f"
        ) ++ Option.when(isOneGone)(if record.isHere then "" else "gone")
    s"""${counts.accepted} blocks counted, ${now.resumed} more were in the ledger; ${counts.repeated} answers came twice, ${counts.lost} blocks were lost with their workers and given out again
       |${TextTable(
        Vector("<worker", "cores", "counted", "share", "repeated", "busy, s") ++ Option.when(isOneGone)("<"),
        rows.take(ClusterRun.MostRows)
      ).render}${
        if rows.size > ClusterRun.MostRows then s"\nand ${rows.size - ClusterRun.MostRows} more" else ""
      }""".stripMargin

private[cli] object ClusterRun:
  private val MostRows = 40

  /** The command line of a worker of this machine. With certificates it listens where its own is valid: at
    * the coordinator's host.
    */
  private[cli] def words(options: ClusterOptions.Checked, at: Address, threads: Int): Seq[String] =
    Seq("worker", "--join", at.toString, "--attached", "--threads") ++
      Seq((threads / options.workers.max(1)).max(1).toString) ++
      options.tls.toSeq.flatMap(tls =>
        Seq("--tls", tls.keyStore.toAbsolutePath.getParent.toString, "--listen", at.copy(port = 0).toString)
      )

  /** Whether a worker is here that is not one of those that have ended: progress may lag behind. */
  private[cli] def isOtherHere(progress: ClusterProgress, hasEnded: String => Boolean): Boolean =
    progress.coordinator.workers.exists((name, worker) => worker.isHere && !hasEnded(name))

  /** Identifies a question in its ledger: another build may answer it otherwise. */
  private[cli] def ledgerName(question: ArraySeq[Byte], build: String): ArraySeq[Byte] =
    val digest = MessageDigest.getInstance("SHA-256")
    digest.update(s"$build\n".getBytes(UTF_8))
    ArraySeq.unsafeWrapArray(digest.digest(question.toArray))

  /** Runs `body` with a coordinator and workers, and stops them afterwards.
    *
    * @param program the class whose `main` starts the commands
    * @param folder holds the ledger and the workers' logs
    * @param threads total number of threads of the workers that it starts
    */
  def using[A](
      options: ClusterOptions.Checked,
      program: String,
      question: ArraySeq[Byte],
      folder: Path,
      threads: Int,
      shown: Shown
  )(body: ClusterRun => Either[String, A]): Either[String, A] =
    for
      ledger <- Ledger.open(folder.resolve(Ledger.Name), ledgerName(question, BuildId.current))
      _ = if ledger.broken > 0 then
        shown.say(
          s"${folder.resolve(Ledger.Name)}: ${ledger.broken} bytes are no whole answers, since they were cut off " +
            "or damaged; these blocks are computed again"
        )
      ended <-
        try
          CoordinatorNode
            .start(options.listen, options.tls, question, ledger)(news => Console.err.println(news.text))
            .flatMap(node => ClusterRun(node, options, program, folder, threads, shown).run(body))
        finally ledger.close()
    yield ended
