package skein.cli

import com.typesafe.config.{Config, ConfigFactory}
import java.util.concurrent.ConcurrentLinkedDeque
import java.util.logging.{Handler, Level, LogRecord, Logger}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.Duration
import scala.concurrent.{Await, Future}
import scala.jdk.CollectionConverters.*
import skein.link.TransportError
import skein.units.OwnFailure

/** Blocks a command's main thread on asynchronous work. */
private[cli] object Edge:

  def await[A](future: Future[A]): A = Await.result(future, Duration.Inf)

  /** Runs `body` with an actor system, which ends afterwards.
    *
    * @return Left also says why a transport failed
    */
  def withSystem[A](name: String, settings: => Config = ConfigFactory.load())(
      body: ActorSystem ?=> Either[String, A]
  ): Either[String, A] =
    val system = ActorSystem(name, settings)
    try body(using system)
    catch case error: TransportError => Left(error.getMessage)
    finally await(system.terminate()): Unit

  @volatile private var interrupted = false

  /** Whether Ctrl-C is ending the program: then a shutdown hook waits for the main thread, and calling
    * `sys.exit` would deadlock with it.
    */
  def isInterrupted: Boolean = interrupted

  /** Runs `body`; if the process is terminated from outside meanwhile, prints a line about it, with the
    * progress so far.
    */
  def tellingIfCut[A](progress: => String)(body: => A): A = hooked(body):
    val how = if exitedAt.isEmpty then "ended from outside; " else ""
    Console.err.println(s"skein: $how$progress")

  /** Runs `body`; if user code ends the process meanwhile, prints a line about it, since nothing else would.
    */
  def tellingExit[A](body: => A): A = hooked(body):
    exitedAt.foreach(at => Console.err.println(s"skein: ended by System.exit in $at"))

  private def hooked[A](body: => A)(atEnd: => Unit): A =
    val hook = Thread(() => atEnd)
    val _    = added(hook)
    try body
    finally removeHook(hook)

  /** The line of code that called `System.exit`, if any did: then the process was not terminated from
    * outside. The JVM logs the call, also from virtual threads, which thread dumps omit.
    */
  private def exitedAt: Option[String] = exited.flatMap(OwnFailure.line(_))

  @volatile private var exited = Option.empty[Vector[StackTraceElement]]

  /** Not `private`, so that a field holds it: unreferenced loggers are garbage-collected. */
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

  /** Stops whatever [[untilInterrupted]] runs now, as Ctrl-C would; the process continues. */
  def interrupt(): Unit = stops.asScala.foreach(_())

  /** Runs `body`; on Ctrl-C calls `stop` first and lets `body` end by itself, for at most `graceMillis`. If
    * user code ends the process, waits only briefly: `body` may wait for that code, and so for ever.
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

  /** @return `false` if the JVM is shutting down already, and accepts no more hooks */
  private def added(hook: Thread): Boolean =
    try
      Runtime.getRuntime.addShutdownHook(hook)
      true
    catch case _: IllegalStateException => false

  private def removeHook(hook: Thread): Unit =
    try
      val _ = Runtime.getRuntime.removeShutdownHook(hook)
    catch case _: IllegalStateException => () // The JVM is shutting down: the hook runs.
