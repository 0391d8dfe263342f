package skein.flow

import java.lang.foreign.{Arena, FunctionDescriptor, Linker, ValueLayout}
import java.util.concurrent.ThreadFactory
import java.util.concurrent.atomic.AtomicInteger
import scala.util.Try

/** Threads that work only while nobody else wants the processor. */
object BackgroundThread:

  /** Daemon threads of the lowest priority. Java's priorities have no effect on Linux, so there each thread puts itself
    * under the policy `SCHED_IDLE` (see sched(7)), which any process may do: a thread that wakes up takes the processor
    * from it at once.
    */
  def factory(name: String): ThreadFactory =
    val count = AtomicInteger()
    (work: Runnable) =>
      val thread = Thread(
        () =>
          val _ = becomeIdle()
          work.run()
        ,
        s"$name-${count.incrementAndGet()}"
      )
      thread.setDaemon(true)
      thread.setPriority(Thread.MIN_PRIORITY)
      thread

  /** Puts the calling thread under `SCHED_IDLE`; says whether the system did so. */
  private[flow] def becomeIdle(): Boolean =
    System.getProperty("os.name") == "Linux" && Try(schedule()).getOrElse(false)

  private def schedule(): Boolean =
    val linker = Linker.nativeLinker()
    val call   = linker.downcallHandle(
      linker.defaultLookup().findOrThrow("sched_setscheduler"),
      FunctionDescriptor.of(
        ValueLayout.JAVA_INT,
        ValueLayout.JAVA_INT,
        ValueLayout.JAVA_INT,
        ValueLayout.ADDRESS
      )
    )
    val arena = Arena.ofConfined()
    try
      // struct sched_param holds one int, the priority: 0 under this policy. Process 0 is the calling thread.
      val parameter      = arena.allocate(ValueLayout.JAVA_INT)
      val result: AnyRef =
        call.invokeWithArguments(Int.box(0), Int.box(Idle), parameter)
      result == Int.box(0)
    finally arena.close()

  /** `SCHED_IDLE` in Linux's sched.h. */
  private val Idle = 5
