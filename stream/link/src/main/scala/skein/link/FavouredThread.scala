package skein.link

import java.lang.foreign.ValueLayout
import java.util.concurrent.ThreadFactory
import scala.util.Try

/** Threads that take precedence over all others except [[ControlThreads]], where the system allows it: for
  * work that takes milliseconds and must not wait for a busy machine, such as writing a recording. They have
  * the policy [[SchedulingPolicy.Favoured]]. Where it is refused, they have the largest share of a processor
  * that Linux grants by niceness, see setpriority(2), which needs a limit of `ulimit -e 40`; niceness matters
  * only among the threads of the user's session.
  */
object FavouredThread:

  def factory(name: String): ThreadFactory =
    val threads = Thread.ofPlatform().daemon().name(s"$name-", 1).factory()
    work =>
      threads.newThread: () =>
        for thread <- SchedulingPolicy.thisThread do
          if !SchedulingPolicy.Favoured.schedule(thread) then favour(thread): Unit
        work.run()

  /** @param thread the system's number; threads that it starts inherit its niceness
    * @return whether the system did so
    */
  private def favour(thread: Int): Boolean = Try(call(0, thread, -20)).getOrElse(false)

  private lazy val call = SchedulingPolicy.function("setpriority", ValueLayout.JAVA_INT)
