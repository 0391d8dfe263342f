package skein.environment

import java.util.concurrent.Semaphore
import scala.util.control.ControlThrowable

/** A computation that is suspended and gone on with. It has a virtual thread of its own, which waits in
  * between; only one of the two runs at a time.
  *
  * @param body is given what suspends it; need not end
  */
private final class Resumed(body: (() => Unit) => Unit) extends AutoCloseable:
  import Resumed.GivenUp

  private val goesOn, waits          = Semaphore(0)
  @volatile private var failure      = Option.empty[Throwable]
  @volatile private var isGivenUp    = false
  private var thread: Option[Thread] = None

  /** Lets it run. Nothing may be read that it writes until [[await]] has returned. */
  def goOn(): Unit = thread match
    case None    => thread = Some(Thread.ofVirtual.name("episode").start(() => run()))
    case Some(_) => goesOn.release()

  /** Blocks until it is suspended, or has ended.
    *
    * @throws Throwable what it threw
    */
  def await(): Unit =
    waits.acquireUninterruptibly()
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

  /** Nobody goes on with it any more. */
  def close(): Unit =
    isGivenUp = true
    goesOn.release()

private object Resumed:
  private object GivenUp extends ControlThrowable
