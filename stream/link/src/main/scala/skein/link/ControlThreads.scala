package skein.link

import java.util.concurrent.{ConcurrentHashMap, ThreadFactory}
import scala.jdk.CollectionConverters.*

/** The threads on the path of readings, decisions and commands: the threads of the scheduler, of sockets, and
  * of Pekko's dispatchers that are [[ControlExecutor]]s. They neither block nor compute for long.
  */
object ControlThreads:
  private val alive                 = ConcurrentHashMap.newKeySet[Int]()
  @volatile private var haveTheLead = false

  /** Gives the control threads precedence over all other threads of the machine, where the system allows it,
    * and likewise the garbage collector's threads, for which control threads wait. Call it after a warm-up:
    * earlier, the compilers would hardly run. Collects garbage once, for some 20 ms, so that later
    * collections do not copy the live objects again.
    *
    * @return the number of threads to which the system granted it
    */
  def lead(): Int =
    haveTheLead = true
    val leading =
      (alive.asScala ++ SchedulingPolicy.threadsNamed(Collectors*)).count(SchedulingPolicy.RealTime.schedule)
    System.gc()
    leading

  /** Name prefixes of HotSpot's threads that run while all others are stopped. */
  private val Collectors = Vector("GC Thread", "VM Thread")

  /** A factory whose threads are control threads. */
  private[link] def of(factory: ThreadFactory): ThreadFactory = work =>
    factory.newThread: () =>
      enter()
      try work.run()
      finally leave()

  /** Adds the calling thread to the control threads. */
  private[link] def enter(): Unit =
    for thread <- SchedulingPolicy.thisThread do
      alive.add(thread): Unit
      if haveTheLead then SchedulingPolicy.RealTime.schedule(thread): Unit

  /** Removes the calling thread, which is about to end. */
  private[link] def leave(): Unit = SchedulingPolicy.thisThread.foreach(alive.remove)
