package skein.cluster

import java.io.IOException
import java.lang.management.ManagementFactory
import java.nio.file.{Files, Path}
import java.util.concurrent.TimeUnit
import java.util.concurrent.atomic.AtomicInteger
import scala.jdk.CollectionConverters.*
import scala.util.Using

/** Workers as processes of this machine. They end with this process, however it ends: each has a pipe from
  * it, and ends when the pipe closes ([[WorkerProcesses.endWithParent]]).
  *
  * A process that ends is replaced, unless several in a row computed nothing: they crash, or are refused.
  *
  * @param command the command line that starts a worker
  * @param log the log file of a worker, by the worker's number from 1
  * @param onEnd called with the name of a worker whose process has ended, on a thread of its own; returns
  *   whether it had computed anything
  * @param onGivenUp called with a reason when no process is left and none is started again
  */
final class WorkerProcesses(
    count: Int,
    command: Seq[String],
    log: Int => Path,
    onEnd: String => Boolean,
    onGivenUp: String => Unit
) extends AutoCloseable:
  import WorkerProcesses.*

  private var processes = Map.empty[Int, Process]
  private var isStarted = false
  private var isClosing = false

  /** Processes that ended in a row without having computed anything. */
  private val idle = AtomicInteger()

  def start(): Unit =
    val first = synchronized:
      val is = !isStarted
      isStarted = true
      is
    if first then for number <- 1 to count do begin(number)

  private def begin(number: Int): Unit = synchronized:
    if !isClosing then
      val builder = starting(command)
      builder.redirectErrorStream(true)
      builder.redirectOutput(ProcessBuilder.Redirect.appendTo(log(number).toFile))
      val process = builder.start()
      processes += number -> process
      process.onExit.thenAccept(_ => ended(number, process)): Unit

  private def ended(number: Int, process: Process): Unit =
    val hasComputed = onEnd(WorkerNode.nameOf(process.pid()))
    if hasComputed then idle.set(0)
    val again = synchronized:
      processes -= number
      !isClosing && (hasComputed || idle.incrementAndGet() <= MostIdle)
    val why =
      if again then
        try
          begin(number)
          None
        catch case failure: IOException => Some(s"workers cannot be started again: ${failure.getMessage}")
      else
        Some(
          "the workers on this machine end before they have computed anything, with " +
            s"status ${process.exitValue}: see ${log(number)}"
        )
    if synchronized(!isClosing && processes.isEmpty) then why.foreach(onGivenUp)

  /** Ends all processes, and waits for them for a limited time. */
  def close(): Unit =
    val left = synchronized:
      isClosing = true
      processes.values.toVector
    left.foreach(_.getOutputStream.close())
    val deadline = System.nanoTime() + Grace
    for process <- left do
      if !process.waitFor((deadline - System.nanoTime()).max(0), TimeUnit.NANOSECONDS) then
        process.destroyForcibly(): Unit

object WorkerProcesses:
  private val MostIdle = 3
  private val Grace    = 5_000_000_000L

  /** The workers' archive for a program's archive: `X-worker.jsa` for `X.jsa`. */
  private[cluster] def ofWorkers(option: String): String =
    if option.startsWith(Archive) && !option.endsWith(OfWorkers) then
      option.stripSuffix(".jsa") + OfWorkers
    else option

  private val Archive   = "-XX:SharedArchiveFile="
  private val OfWorkers = "-worker.jsa"

  /** Prepares starting a worker. A class archive that was not completely written, since the JVM that wrote it
    * was killed, is removed: the JVM would neither read nor replace it, and all later workers would start
    * slowly.
    */
  def starting(command: Seq[String]): ProcessBuilder =
    command
      .filter(_.startsWith(Archive))
      .map(option => Path.of(option.stripPrefix(Archive)))
      .filter(isCutOff)
      .foreach(Files.deleteIfExists(_))
    ProcessBuilder(command*)

  /** Whether an archive is incomplete: the JVM writes its first bytes last. */
  private def isCutOff(archive: Path): Boolean =
    Files.isRegularFile(archive) && Using.resource(Files.newInputStream(archive))(_.read()) <= 0

  /** In a worker: calls `end` once the process that started it has ended, or closed its pipe. */
  def endWithParent(end: () => Unit): Unit =
    val watching = Thread(() =>
      try while System.in.read() >= 0 do ()
      catch case _: IOException => ()
      end()
    )
    watching.setDaemon(true)
    watching.setName("parent")
    watching.start()

  /** A command that runs a program like this one: with this JVM, its options and class path, but another
    * archive of classes, since workers need other classes: the first worker makes it.
    *
    * @param program the class with `main`
    */
  def likeThis(program: String, words: Seq[String]): Seq[String] =
    val options = ManagementFactory.getRuntimeMXBean.getInputArguments.asScala
      .filterNot(option => option.startsWith("-agentlib") || option.startsWith("-Xrun"))
      .map(ofWorkers)
    val java = Path.of(sys.props("java.home"), "bin", "java").toString
    (java +: options.toSeq) ++ Seq("-cp", sys.props("java.class.path"), program) ++ words
