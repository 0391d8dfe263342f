package skein.environment

import java.util.concurrent.Semaphore
import scala.util.control.ControlThrowable

/** A computation that can be suspended and continued. It has a virtual thread of its own, which waits in
  * between; this thread and the caller's never run simultaneously.
  *
  * @param body the computation, which need not end; receives the function that suspends it
  */
private final class Resumed(body: (() => Unit) => Unit) extends AutoCloseable:
  import Resumed.GivenUp

  private val goesOn, waits          = Semaphore(0)
  @volatile private var failure      = Option.empty[Throwable]
  @volatile private var isGivenUp    = false
  private var thread: Option[Thread] = None

  /** Continues the computation. Nothing that it writes may be read until [[await]] has returned.
    *
    * @throws Throwable if the computation threw it before
    */
  def goOn(): Unit =
    failure.foreach(throw _)
    thread match
      case None    => thread = Some(Thread.ofVirtual.name("episode").start(() => run()))
      case Some(_) => goesOn.release()

  /** Blocks until the computation is suspended or has ended.
    *
    * @throws Throwable if the computation threw it
    */
  def await(): Unit =
    if failure.isEmpty then waits.acquireUninterruptibly()
    failure.foreach(throw _)

  private def run(): Unit =
    try body(() => suspend())
    catch
      case GivenUp          => ()
      case wrong: Throwable => failure = Some(wrong)
    finally waits.release()

  private def suspend(): Unit =
    waits.release()
    goesOn.acquireUninterruptibly()
    if isGivenUp then throw GivenUp

  /** Abandons the computation; it will not be continued. */
  def close(): Unit =
    isGivenUp = true
    goesOn.release()

private object Resumed:
  private object GivenUp extends ControlThrowable
