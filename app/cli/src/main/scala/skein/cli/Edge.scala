package skein.cli

import java.util.concurrent.ConcurrentLinkedDeque
import java.util.logging.{Handler, Level, LogRecord, Logger}
import scala.concurrent.duration.Duration
import scala.concurrent.{Await, Future}
import scala.jdk.CollectionConverters.*
import skein.units.OwnFailure

/** Where a command's main thread waits for what runs asynchronously. */
private[cli] object Edge:

  def await[A](future: Future[A]): A = Await.result(future, Duration.Inf)

  @volatile private var interrupted = false

  /** Whether Ctrl-C ends the program: then a hook waits for the main thread to end by itself, and `sys.exit`
    * would wait for the hook.
    */
  def isInterrupted: Boolean = interrupted

  /** Runs `body`; if the program is ended from outside meanwhile, says so, and how far it was. */
  def tellingIfCut[A](progress: => String)(body: => A): A = hooked(body):
    val how = if exitedAt.isEmpty then "ended from outside; " else ""
    Console.err.println(s"skein: $how$progress")

  /** Runs `body`; if code of the user's own ends the program meanwhile, says so: nothing else would. */
  def tellingExit[A](body: => A): A = hooked(body):
    exitedAt.foreach(at => Console.err.println(s"skein: ended by System.exit in $at"))

  private def hooked[A](body: => A)(atEnd: => Unit): A =
    val hook = Thread(() => atEnd)
    val _    = added(hook)
    try body
    finally removeHook(hook)

  /** Where `System.exit` was called, if it was: then nobody has ended the program from outside. The JVM tells
    * a logger, also of virtual threads, which no list of threads has.
    */
  private def exitedAt: Option[String] = exited.flatMap(OwnFailure.line(_))

  @volatile private var exited = Option.empty[Vector[StackTraceElement]]

  /** Not `private`: then no field would hold it, and loggers that nobody holds are collected. */
  private[cli] val exits: Logger = Logger.getLogger("java.lang.Runtime")
  exits.setUseParentHandlers(false)
  exits.setLevel(Level.FINE)
  exits.addHandler(new Handler:
    def publish(told: LogRecord): Unit =
      exited = Option(told.getThrown).map(_.getStackTrace.toVector)
    def flush(): Unit = ()
    def close(): Unit = ())

  private val OwnExitMillis = 2_000L

  private val stops = ConcurrentLinkedDeque[() => Unit]()

  /** Ends whatever runs [[untilInterrupted]] now, as Ctrl-C would; the process goes on. */
  def interrupt(): Unit = stops.asScala.foreach(_())

  /** Runs `body`; on Ctrl-C calls `stop` first and lets `body` come to its own end, for at most
    * `graceMillis`. Where code of the user's own ends the program, for a short while: `body` may wait for
    * that code, and so for ever.
    */
  def untilInterrupted[A](stop: () => Unit, graceMillis: Long = 15_000)(body: => A): A =
    val main = Thread.currentThread()
    val hook = Thread(() =>
      interrupted = true
      stop()
      main.join(if exitedAt.isEmpty then graceMillis else graceMillis.min(OwnExitMillis))
    )
    if !added(hook) then
      interrupted = true
      stop()
    stops.add(stop): Unit
    try body
    finally
      stops.remove(stop): Unit
      removeHook(hook)

  /** @return `false` where the JVM is shutting down already, and so waits for nobody
    */
  private def added(hook: Thread): Boolean =
    try
      Runtime.getRuntime.addShutdownHook(hook)
      true
    catch case _: IllegalStateException => false

  private def removeHook(hook: Thread): Unit =
    try
      val _ = Runtime.getRuntime.removeShutdownHook(hook)
    catch case _: IllegalStateException => () // The JVM is shutting down: the hook runs.
