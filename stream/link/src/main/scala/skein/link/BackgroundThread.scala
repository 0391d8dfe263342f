package skein.link

import java.lang.management.ManagementFactory
import java.util.concurrent.ThreadFactory
import java.util.concurrent.locks.LockSupport
import skein.units.Span

/** Runs slices of work on a thread that yields the processor to all others of the user's session.
  *
  * It does so by Linux's [[SchedulingPolicy.Idle]]. Where other programs of the session keep all processors
  * busy, such a thread hardly runs, and the JVM, which stops all threads from time to time, waits for one
  * that is ready to run. So a thread that did not get the processor for more than `patience` in one slice is
  * replaced by an ordinary one, since Linux lets no thread leave that class. Sleeping or waiting in a slice
  * counts as not getting it.
  *
  * @param factory makes threads with idle priority
  * @param usual makes ordinary threads
  * @param slice works for milliseconds, on one thread at a time; returns whether there was anything to do
  */
final class BackgroundThread(
    factory: ThreadFactory,
    usual: ThreadFactory,
    patience: Span = BackgroundThread.Patience
)(slice: () => Boolean)
    extends AutoCloseable:
  @volatile private var isClosed = false
  @volatile private var thread   = factory.newThread(() => work(givesWay = true))
  thread.start()

  /** Wakes the thread for new work. Never blocks. */
  def wake(): Unit = LockSupport.unpark(thread)

  /** Ends the thread after the current slice. */
  def close(): Unit =
    isClosed = true
    wake()

  /** Ends the thread, even in a slice that waits. */
  def interrupt(): Unit =
    isClosed = true
    thread.interrupt()

  private def work(givesWay: Boolean): Unit =
    var isReplaced = false
    while !isReplaced && !isClosed do
      val begun = System.nanoTime
      val ran   = BackgroundThread.ranNanos
      if !slice() then LockSupport.park(this)
      else if givesWay then
        val computed = BackgroundThread.ranNanos - ran
        isReplaced = System.nanoTime - begun - computed > patience.toNanos
    if isReplaced && !isClosed then
      thread = usual.newThread(() => work(givesWay = false))
      thread.start()

object BackgroundThread:
  /** Shorter than the silence that a simulator may keep before it is reported as silent. */
  val Patience: Span = Span.ofMillis(300)

  private val meter = ManagementFactory.getThreadMXBean

  /** Processor time of the calling thread; 0 where the system does not report it. */
  private def ranNanos: Long =
    if meter.isCurrentThreadCpuTimeSupported then meter.getCurrentThreadCpuTime.max(0) else 0

  /** A factory of daemon threads with idle priority. */
  def factory(name: String): ThreadFactory =
    val threads = Thread.ofPlatform().daemon().priority(Thread.MIN_PRIORITY).name(s"$name-", 1).factory()
    work =>
      threads.newThread: () =>
        SchedulingPolicy.thisThread.foreach(SchedulingPolicy.Idle.schedule)
        work.run()

  /** A factory of daemon threads with ordinary priority. */
  def usual(name: String): ThreadFactory = Thread.ofPlatform().daemon().name(s"$name-usual-", 1).factory()

  /** Lowers the JVM's compiler threads to the scheduler's idle class. Call it after a warm-up, when most of
    * the program is compiled.
    *
    * @return the number of threads that the system lowered
    */
  def compilersGiveWay(): Int =
    SchedulingPolicy.threadsNamed(CompilerNames*).count(SchedulingPolicy.Idle.schedule)

  /** Name prefixes of HotSpot's compiler threads. */
  private val CompilerNames = Vector("C1 Comp", "C2 Comp")
