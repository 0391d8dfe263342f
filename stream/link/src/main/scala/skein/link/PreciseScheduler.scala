package skein.link

import com.typesafe.config.{Config, ConfigFactory}
import java.io.Closeable
import java.util.concurrent.atomic.{AtomicBoolean, AtomicReference}
import java.util.concurrent.{
  ConcurrentHashMap,
  RejectedExecutionException,
  ScheduledFuture,
  ScheduledThreadPoolExecutor,
  ThreadFactory
}
import org.apache.pekko.PekkoException
import org.apache.pekko.actor.{Cancellable, Scheduler, SchedulerTask}
import org.apache.pekko.event.LoggingAdapter
import scala.concurrent.ExecutionContext
import scala.concurrent.duration.{FiniteDuration, NANOSECONDS}
import scala.jdk.CollectionConverters.*
import scala.util.control.{NoStackTrace, NonFatal}

/** Pekko's scheduler for loops that must act on time: a task starts about 0.1 ms after it is due and never
  * before, where Pekko's default wheel rounds up to ticks of 10 ms. One thread and a heap: scheduling and
  * cancelling cost O(log n), and a cancelled task leaves no trace.
  *
  * Chosen by `pekko.scheduler.implementation`; Pekko calls this constructor by reflection. As any Pekko
  * scheduler it runs tasks on the caller's execution context, refuses tasks once closed
  * (`IllegalStateException`), and runs what is marked `TaskRunOnClose` when it closes.
  * `PreciseSchedulerLiveSuite` measures it.
  */
final class PreciseScheduler(
    @scala.annotation.unused config: Config,
    log: LoggingAdapter,
    threads: ThreadFactory
) extends Scheduler
    with Closeable:
  import PreciseScheduler.*

  private val timer = ScheduledThreadPoolExecutor(1, ControlThreads.of(threads))
  timer.setRemoveOnCancelPolicy(true)
  timer.setExecuteExistingDelayedTasksAfterShutdownPolicy(false)

  private val onClose = ConcurrentHashMap.newKeySet[Once]()

  /** Maximum number of one repeating task's executions per second. */
  def maxFrequency: Double = 10_000

  def scheduleOnce(delay: FiniteDuration, runnable: Runnable)(using executor: ExecutionContext): Cancellable =
    val task = Once(runnable, executor)
    try
      if delay.toNanos > 0 then task.timed = timer.schedule(task, delay.toNanos, NANOSECONDS)
      else if timer.isShutdown then throw RejectedExecutionException()
      else task.run()
    catch
      case _: RejectedExecutionException =>
        throw IllegalStateException("cannot schedule: the timer is closed")
    task

  @deprecated("As in Pekko: use scheduleWithFixedDelay or scheduleAtFixedRate.", "Pekko 1.0")
  def schedule(initialDelay: FiniteDuration, interval: FiniteDuration, runnable: Runnable)(using
      executor: ExecutionContext
  ): Cancellable =
    requirePositive(interval)
    var due = System.nanoTime() + initialDelay.toNanos
    Repeating(runnable, initialDelay): () =>
      due += interval.toNanos
      due - System.nanoTime()

  override def scheduleWithFixedDelay(initialDelay: FiniteDuration, delay: FiniteDuration)(
      runnable: Runnable
  )(using executor: ExecutionContext): Cancellable =
    requirePositive(delay)
    Repeating(runnable, initialDelay)(() => delay.toNanos)

  def close(): Unit =
    timer.shutdownNow(): Unit
    for task <- onClose.asScala do
      try task.runnable.run()
      catch case NonFatal(e) => log.error(e, "a task to run on close failed")

  private def requirePositive(period: FiniteDuration): Unit =
    require(period.toNanos > 0, s"a repeated task needs a period above zero, got $period")

  private final class Once(val runnable: Runnable, executor: ExecutionContext) extends Runnable
      with Cancellable:
    private val state = AtomicReference(State.Pending)

    @volatile var timed: ScheduledFuture[?] | Null = null

    if runnable.isInstanceOf[Scheduler.TaskRunOnClose] then onClose.add(this): Unit

    def run(): Unit =
      if leavePending(State.Started) then
        try executor.execute(runnable)
        catch case NonFatal(e) => executor.reportFailure(e)

    def cancel(): Boolean =
      val first = leavePending(State.Cancelled)
      if first then
        Option(timed).foreach(_.cancel(false))
        tellCancelled(runnable)
      first

    def isCancelled: Boolean = state.get == State.Cancelled

    private def leavePending(next: State): Boolean =
      val first = state.compareAndSet(State.Pending, next)
      if first && runnable.isInstanceOf[Scheduler.TaskRunOnClose] then onClose.remove(this): Unit
      first

  /** Runs repeatedly until cancelled or until the task throws; `nextDelayNanos` is evaluated after each run.
    */
  private final class Repeating(
      runnable: Runnable,
      initialDelay: FiniteDuration
  )(nextDelayNanos: () => Long)(using
      executor: ExecutionContext
  ) extends Runnable
      with Cancellable:
    private val stopped = AtomicBoolean()
    // Cancelling the pending task only frees its memory earlier: `stopped` alone decides.
    @volatile private var pending = scheduleOnce(initialDelay, this)

    def run(): Unit =
      try
        if !stopped.get then
          runnable.run()
          if !stopped.get then
            pending = scheduleOnce(FiniteDuration(nextDelayNanos(), NANOSECONDS), this)
      catch
        case _: IllegalStateException if timer.isShutdown => ()
        // Pekko's private SchedulerException: a message's receiver has terminated, so its timer ends.
        case _: (PekkoException & NoStackTrace) => ()

    def cancel(): Boolean =
      val first = stopped.compareAndSet(false, true)
      if first then
        pending.cancel(): Unit
        tellCancelled(runnable)
      first

    def isCancelled: Boolean = stopped.get

object PreciseScheduler:

  /** The program's configuration with this scheduler in place of Pekko's, and with [[ControlThreads]]. */
  def config: Config =
    ConfigFactory.parseResources("skein/link/punctual.conf").withFallback(ConfigFactory.load())

  private enum State:
    case Pending, Started, Cancelled

  private def tellCancelled(runnable: Runnable): Unit = runnable match
    case task: SchedulerTask => task.cancelled()
    case _                   => ()
