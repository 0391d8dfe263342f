package skein.link

import java.util.concurrent.{ConcurrentLinkedQueue, Executor, ThreadFactory}
import skein.units.Span

/** Runs what it is given, in order, on a [[BackgroundThread]]: each is a slice of it, so it should take
  * milliseconds. Who gives it work bounds how much waits.
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

  /** Runs nothing more, and interrupts what runs. */
  def close(): Unit = thread.interrupt()

object BackgroundExecutor:
  def apply(name: String): BackgroundExecutor =
    new BackgroundExecutor(BackgroundThread.factory(name), BackgroundThread.usual(name))
