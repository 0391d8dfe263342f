package skein.vtime

import com.typesafe.config.Config
import java.util.concurrent.ThreadFactory
import org.apache.pekko.actor.{Cancellable, Scheduler, SchedulerTask}
import org.apache.pekko.event.LoggingAdapter
import scala.annotation.unused
import scala.concurrent.ExecutionContext
import scala.concurrent.duration.*
import skein.vtime.agent.Guard

/** The actor system's scheduler on the loop: exact to the nanosecond. Pekko makes it by reflection, hence the
  * parameters.
  */
private final class LoopScheduler(
    @unused config: Config,
    @unused log: LoggingAdapter,
    @unused threads: ThreadFactory
) extends Scheduler
    with java.io.Closeable
    with Guard:
  val loop: Loop     = Loop.current
  private var closed = false

  def maxFrequency: Double = 1e9

  def delivered(): Unit = loop.requireOwnThread("sent a message to an actor")

  def scheduleOnce(delay: FiniteDuration, runnable: Runnable)(using ExecutionContext): Cancellable =
    if closed then throw IllegalStateException("the scheduler of this actor system is closed")
    val once = Once(runnable, summon)
    once.start(delay)
    once

  def schedule(initialDelay: FiniteDuration, interval: FiniteDuration, runnable: Runnable)(using
      executor: ExecutionContext
  ): Cancellable =
    require(interval.length > 0, s"interval must be positive, but is $interval")
    val repeated = Repeated(interval, runnable, executor)
    repeated.start(initialDelay)
    repeated

  /** Closes as Pekko's own scheduler does: tasks that must run at the end do, others are cancelled. */
  def close(): Unit =
    closed = true
    loop.removeTimers().foreach:
      case once: Once => once.close()
      case _          => ()

  private final class Once(runnable: Runnable, executor: ExecutionContext) extends Cancellable with Runnable:
    private var timer: Option[Timer] = None
    private var cancelled            = false

    def start(delay: FiniteDuration): Unit =
      timer = Some(loop.schedule(delay, this))

    def run(): Unit =
      timer = None
      executor.execute(runnable)

    def cancel(): Boolean = timer match
      case Some(pending) =>
        loop.cancel(pending)
        timer = None
        cancelled = true
        true
      case None => false

    def isCancelled: Boolean = cancelled

    def close(): Unit =
      timer = None
      runnable match
        case last: Scheduler.TaskRunOnClose => last.run()
        case task: SchedulerTask            => task.cancelled()
        case _                              =>

  /** Repeats until cancelled, until the task throws, or until the scheduler is closed. */
  private final class Repeated(interval: FiniteDuration, runnable: Runnable, executor: ExecutionContext)
      extends Cancellable
      with Runnable:
    private var next: Option[Cancellable] = None
    private var cancelled                 = false

    def start(delay: FiniteDuration): Unit = next = Some(scheduleOnce(delay, this)(using executor))

    def run(): Unit =
      runnable.run()
      if !cancelled && !closed then start(interval)

    def cancel(): Boolean =
      val first = !cancelled
      cancelled = true
      next.foreach(_.cancel())
      first

    def isCancelled: Boolean = cancelled
