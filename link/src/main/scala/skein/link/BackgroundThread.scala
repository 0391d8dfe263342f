package skein.link

import java.util.concurrent.ThreadFactory
import java.util.concurrent.atomic.AtomicInteger

/** Threads that give way to all others of the user's session.
  *
  * By Linux's [[SchedulingPolicy.Idle]]. Its price: where other programs of the session keep all processors
  * busy, such a thread hardly runs, and the JVM, which stops all threads now and then, waits for one that is
  * ready to run; 0.8 s were seen.
  */
object BackgroundThread:

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

  /** Lowers the JVM's compiler threads to the scheduler's idle class. Call it after a warm-up, when most of
    * the program is compiled.
    *
    * @return how many the system made do so
    */
  def compilersGiveWay(): Int =
    SchedulingPolicy.threadsNamed(CompilerNames*).count(SchedulingPolicy.Idle.schedule)

  /** As HotSpot calls its compiler threads. */
  private val CompilerNames = Vector("C1 Comp", "C2 Comp")
