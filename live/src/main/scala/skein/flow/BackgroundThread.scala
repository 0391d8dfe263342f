package skein.flow

import java.lang.foreign.{FunctionDescriptor, Linker, ValueLayout}
import java.util.concurrent.ThreadFactory
import java.util.concurrent.atomic.AtomicInteger
import scala.util.Try

/** Threads that give way to all others. */
object BackgroundThread:

  /** Daemon threads of low priority. Java's priorities have no effect on Linux, so there each thread makes itself nicer
    * (see setpriority(2), whose `who` is a thread on Linux), which any process may do: a thread of ours that wakes up
    * takes the processor from it. It is not kept from the processor altogether, since the JVM stops all threads now and
    * then and would wait for one that never runs.
    */
  def factory(name: String): ThreadFactory =
    val count = AtomicInteger()
    (work: Runnable) =>
      val thread = Thread(
        () =>
          val _ = giveWay()
          work.run()
        ,
        s"$name-${count.incrementAndGet()}"
      )
      thread.setDaemon(true)
      thread.setPriority(Thread.MIN_PRIORITY)
      thread

  /** Makes the calling thread nicer; says whether the system did so. */
  private[flow] def giveWay(): Boolean =
    System.getProperty("os.name") == "Linux" && Try(setPriority()).getOrElse(false)

  private def setPriority(): Boolean =
    val linker = Linker.nativeLinker()
    val call   = linker.downcallHandle(
      linker.defaultLookup().findOrThrow("setpriority"),
      FunctionDescriptor.of(
        ValueLayout.JAVA_INT,
        ValueLayout.JAVA_INT,
        ValueLayout.JAVA_INT,
        ValueLayout.JAVA_INT
      )
    )
    val result: AnyRef = call.invokeWithArguments(Int.box(PrioProcess), Int.box(0), Int.box(Nice))
    result == Int.box(0)

  /** `PRIO_PROCESS` in Linux's sys/resource.h; 0 is then the calling thread. */
  private val PrioProcess = 0

  /** A tenth of an ordinary thread's share, where both want the processor. */
  private val Nice = 10
