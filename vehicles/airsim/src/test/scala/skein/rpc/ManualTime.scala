package skein.rpc

import com.typesafe.config.{Config, ConfigFactory}
import java.util.concurrent.ThreadFactory
import org.apache.pekko.actor.{ActorSystem, Cancellable, Scheduler}
import org.apache.pekko.event.LoggingAdapter
import scala.collection.mutable
import scala.concurrent.ExecutionContext
import scala.concurrent.duration.FiniteDuration
import skein.units.*

/** A scheduler and clock that advance only when the test advances them. */
final class ManualTime(config: Config, log: LoggingAdapter, threads: ThreadFactory) extends Scheduler
    with Clock:
  // Pekko makes a scheduler with exactly these arguments.
  locally { val _ = (config, log, threads) }

  private final class Task(val at: Instant, val order: Long, val run: () => Unit) extends Cancellable:
    private var open                = true
    def cancel(): Boolean           = ManualTime.this.synchronized { val was = open; open = false; was }
    def isCancelled: Boolean        = ManualTime.this.synchronized(!open)
    private[ManualTime] def claim() = cancel()

  private var current = Instant.Epoch
  private var order   = 0L
  private val tasks   = mutable.TreeSet.empty[Task](using Ordering.by(task => (task.at.toNanos, task.order)))

  def now(): Instant = synchronized(current)

  /** Advances time and runs everything due, in order. */
  def advance(span: Span): Unit =
    val due = synchronized:
      current = current + span
      val due = tasks.takeWhile(_.at <= current).toSeq
      tasks --= due
      due
    due.filter(_.claim()).foreach(_.run())

  override def scheduleOnce(delay: FiniteDuration, task: Runnable)(using
      executor: ExecutionContext
  ): Cancellable =
    val entry = synchronized:
      order += 1
      Task(current + Span.ofNanos(delay.toNanos), order, () => executor.execute(task))
    if delay.toNanos <= 0 then
      if entry.claim() then entry.run()
    else synchronized { val _ = tasks.add(entry) }
    entry

  override def schedule(first: FiniteDuration, every: FiniteDuration, task: Runnable)(using
      ExecutionContext
  ): Cancellable = throw UnsupportedOperationException("nothing here is periodic")

  override def maxFrequency: Double = 1e9

object ManualTime:
  def system(name: String): ActorSystem =
    val setting = s"pekko.scheduler.implementation = ${classOf[ManualTime].getName}"
    ActorSystem(name, ConfigFactory.parseString(setting).withFallback(ConfigFactory.load()))

  def of(system: ActorSystem): ManualTime = system.scheduler match
    case time: ManualTime => time
    case other            => throw AssertionError(s"not in manual time: $other")
