package skein.link

import java.lang.management.ManagementFactory
import java.util.concurrent.ThreadFactory
import java.util.concurrent.atomic.AtomicInteger
import java.util.concurrent.locks.LockSupport
import skein.units.Span

/** Works on a thread that gives way to all others of the user's session, slice by slice.
  *
  * It does so by Linux's [[SchedulingPolicy.Idle]]. Where other programs of the session keep all processors
  * busy, such a thread hardly runs, and the JVM, which stops all threads now and then, waits for one that is
  * ready to run. So one that was kept from the processor for more than `patience` in one slice is replaced by
  * a usual one, since Linux lets no thread leave that class. One that sleeps or waits in a slice counts as
  * kept from it.
  *
  * @param factory of a thread that gives way
  * @param usual of one that does not
  * @param slice works for milliseconds, on one thread at a time; whether there was anything to do
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

  /** There is something to do. Never blocks. */
  def wake(): Unit = LockSupport.unpark(thread)

  /** Ends the thread after the slice that it works on. */
  def close(): Unit =
    isClosed = true
    wake()

  /** Ends it also within a slice that waits for something. */
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
  /** Less than the silence of a simulator that is told. */
  val Patience: Span = Span.ofMillis(300)

  private val meter = ManagementFactory.getThreadMXBean

  /** What the calling thread has had of the processors; 0 where the system does not tell. */
  private def ranNanos: Long =
    if meter.isCurrentThreadCpuTimeSupported then meter.getCurrentThreadCpuTime.max(0) else 0

  /** Daemon threads that give way. */
  def factory(name: String): ThreadFactory =
    val count = AtomicInteger()
    (work: Runnable) =>
      val thread = Thread(
        () =>
          SchedulingPolicy.thisThread.foreach(SchedulingPolicy.Idle.schedule)
          work.run()
        ,
        s"$name-${count.incrementAndGet()}"
      )
      thread.setDaemon(true)
      thread.setPriority(Thread.MIN_PRIORITY)
      thread

  /** Daemon threads that do not. */
  def usual(name: String): ThreadFactory = Thread.ofPlatform().daemon().name(s"$name-usual-", 1).factory()

  /** Lowers the JVM's compiler threads to the scheduler's idle class. Call it after a warm-up, when most of
    * the program is compiled.
    *
    * @return how many the system made do so
    */
  def compilersGiveWay(): Int =
    SchedulingPolicy.threadsNamed(CompilerNames*).count(SchedulingPolicy.Idle.schedule)

  /** As HotSpot calls its compiler threads. */
  private val CompilerNames = Vector("C1 Comp", "C2 Comp")
