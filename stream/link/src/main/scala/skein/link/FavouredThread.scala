package skein.link

import java.lang.foreign.{FunctionDescriptor, Linker, ValueLayout}
import java.util.concurrent.ThreadFactory
import java.util.concurrent.atomic.AtomicInteger
import scala.util.Try

/** Threads that take precedence over all others except [[ControlThreads]], where the system allows it: for
  * work that takes milliseconds and must not wait for a busy machine, such as writing a recording. They have
  * the policy [[SchedulingPolicy.Favoured]]. Where it is refused, they have the largest share of a processor
  * that Linux grants by niceness, see setpriority(2), which needs a limit of `ulimit -e 40`; niceness matters
  * only among the threads of the user's session.
  */
object FavouredThread:

  def factory(name: String): ThreadFactory =
    val count = AtomicInteger()
    (work: Runnable) =>
      val thread = Thread(
        () =>
          for thread <- SchedulingPolicy.thisThread do
            if !SchedulingPolicy.Favoured.schedule(thread) then favour(thread): Unit
          work.run()
        ,
        s"$name-${count.incrementAndGet()}"
      )
      thread.setDaemon(true)
      thread

  /** @param thread the system's number; threads that it starts inherit its niceness
    * @return whether the system did so
    */
  private def favour(thread: Int): Boolean = Try:
    val result: AnyRef = setPriority.invokeWithArguments(Int.box(0), Int.box(thread), Int.box(-20))
    result == Int.box(0)
  .getOrElse(false)

  private lazy val setPriority =
    val linker = Linker.nativeLinker()
    linker.downcallHandle(
      linker.defaultLookup().findOrThrow("setpriority"),
      FunctionDescriptor.of(
        ValueLayout.JAVA_INT,
        ValueLayout.JAVA_INT,
        ValueLayout.JAVA_INT,
        ValueLayout.JAVA_INT
      )
    )
