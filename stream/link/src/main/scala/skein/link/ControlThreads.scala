package skein.link

import java.util.concurrent.{ConcurrentHashMap, ThreadFactory}
import scala.jdk.CollectionConverters.*

/** The threads that readings, decisions and commands pass through: the scheduler's, those of sockets, and
  * those of Pekko's dispatchers that are [[ControlExecutor]]s. They do not wait and do not compute for long.
  */
object ControlThreads:
  private val alive                 = ConcurrentHashMap.newKeySet[Int]()
  @volatile private var haveTheLead = false

  /** From now on they run before all other threads of the machine, where the system allows it, and so do the
    * collectors, for which they wait. Call it after a warm-up: meanwhile the compilers would hardly run. What
    * lives then is collected once, for some 20 ms, so that later collections do not copy it again and again.
    *
    * @return how many do
    */
  def lead(): Int =
    haveTheLead = true
    val leading =
      (alive.asScala ++ SchedulingPolicy.threadsNamed(Collectors*)).count(SchedulingPolicy.RealTime.schedule)
    System.gc()
    leading

  /** As HotSpot calls what runs while all others are stopped. */
  private val Collectors = Vector("GC Thread", "VM Thread")

  /** Threads of `factory` that are among them. */
  private[link] def of(factory: ThreadFactory): ThreadFactory = work =>
    factory.newThread: () =>
      enter()
      try work.run()
      finally leave()

  /** The calling thread is one. */
  private[link] def enter(): Unit =
    for thread <- SchedulingPolicy.thisThread do
      alive.add(thread): Unit
      if haveTheLead then SchedulingPolicy.RealTime.schedule(thread): Unit

  /** The calling thread ends. */
  private[link] def leave(): Unit = SchedulingPolicy.thisThread.foreach(alive.remove)
