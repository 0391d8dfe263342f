package skein.link

import java.util.concurrent.{ConcurrentLinkedQueue, Executor, ThreadFactory}
import skein.units.Span

/** Runs tasks in order on a [[BackgroundThread]]. A task is one slice of the thread's work, so it should take
  * only milliseconds. Callers limit the tasks that wait.
  */
final class BackgroundExecutor(
    factory: ThreadFactory,
    usual: ThreadFactory,
    patience: Span = BackgroundThread.Patience
) extends Executor,
      AutoCloseable:
  private val waiting = ConcurrentLinkedQueue[Runnable]()
  private val thread  = BackgroundThread(factory, usual, patience): () =>
    val next = Option(waiting.poll())
    next.foreach(_.run())
    next.isDefined

  def execute(work: Runnable): Unit =
    val _ = waiting.add(work)
    thread.wake()

  /** Runs nothing more, and interrupts the current task. */
  def close(): Unit = thread.interrupt()

object BackgroundExecutor:
  def apply(name: String): BackgroundExecutor =
    new BackgroundExecutor(BackgroundThread.factory(name), BackgroundThread.usual(name))
