package skein.simulator

import java.util.concurrent.Executor
import java.util.concurrent.atomic.AtomicInteger
import skein.rpc.CallLines

/** Runs long work, such as drawing, on threads of its own, outside the simulation. It runs at most one task
  * less than the machine has processors at a time, and serves the clients in turn, so that no client waits
  * for another's whole queue. The queue is bounded by the calls that a client may have unanswered.
  *
  * @param threads execute the work, which may block
  */
private[simulator] final class Beside(
    threads: Executor,
    most: Int = (Runtime.getRuntime.availableProcessors - 1).max(1)
):
  private val lines   = CallLines[() => Unit](share = 1, batch = 1)
  private val running = AtomicInteger()

  def put(client: Long)(work: => Unit): Unit =
    lines.put(client, () => work)
    start()

  /** Drops a client's work that has not begun. */
  def forget(client: Long): Unit = lines.forget(client)

  @annotation.tailrec
  private def start(): Unit =
    val now = running.get
    if now < most then if running.compareAndSet(now, now + 1) then threads.execute(() => work()) else start()

  private def next(): Option[() => Unit] = synchronized(lines.take())

  private def isIdle = synchronized(lines.isEmpty)

  private def work(): Unit =
    try
      Iterator.continually(next()).takeWhile(_.nonEmpty).flatten.foreach(_())
    finally
      running.decrementAndGet(): Unit
      // Work may have been added since the last check.
      if !isIdle then start()
