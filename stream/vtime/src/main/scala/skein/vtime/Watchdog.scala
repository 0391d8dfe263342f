package skein.vtime

import java.lang.Thread.State
import java.lang.management.ManagementFactory
import scala.concurrent.duration.*

/** Ends a run whose thread stands still, waiting in one task for a lock, a latch or an answer that nobody on
  * the loop can give. One that computes in one task cannot be ended by another thread; that is told once.
  * Looks every half of `patience` (real time).
  *
  * @param begun how many tasks the thread has begun so far
  * @param onEndless where a task is that does not end
  */
private final class Watchdog(
    thread: Thread,
    begun: () => Long,
    patience: FiniteDuration,
    onStandstill: Culprit => Unit,
    onEndless: Array[StackTraceElement] => Unit
):
  import Watchdog.*

  private var stopped = false
  private val watcher = Thread.ofVirtual.start(() => watch())

  /** From here on, the loop's thread may wait as long as it likes, and is not interrupted any more. */
  def stop(): Unit =
    synchronized { stopped = true }
    watcher.interrupt()

  private def watch(): Unit =
    try
      var looks = Vector.empty[Look]
      var told  = false
      while true do
        Thread.sleep((patience / 2).toMillis)
        looks = (looks :+ look()).takeRight(LooksNeeded)
        if standsStill(looks) then end()
        else if !told && isEndless(looks, patience) then
          told = true
          onEndless(thread.getStackTrace)
    catch case _: InterruptedException => ()

  private def look() = Look(waiting.contains(thread.getState), begun(), processorNanos(thread))

  private def end(): Unit = synchronized:
    if !stopped then
      val culprit = Culprit()
      culprit.setStackTrace(thread.getStackTrace)
      onStandstill(culprit)
      thread.interrupt()

private object Watchdog:

  /** What the watchdog sees of the loop's thread.
    *
    * @param waits whether it waits at this moment
    * @param begun tasks begun so far
    * @param processorNanos processor time it has had so far; -1 where the JVM cannot tell
    */
  final case class Look(waits: Boolean, begun: Long, processorNanos: Long)

  val LooksNeeded = 3

  /** On a machine that is busy otherwise a thread may be met waiting again and again, though it works in
    * between, as while classes load: what has had the processor since the look before does not stand still.
    */
  def standsStill(looks: Seq[Look]): Boolean =
    looks.size >= LooksNeeded && looks.forall(look => look.waits && look == looks.head)

  /** Most of the time that the looks lie apart was spent in one task, with the processor. */
  def isEndless(looks: Seq[Look], patience: FiniteDuration): Boolean =
    looks.size >= LooksNeeded && looks.forall(_.begun == looks.head.begun) &&
      looks.last.processorNanos - looks.head.processorNanos > patience.toNanos / 2

  private val waiting = Set(State.BLOCKED, State.WAITING, State.TIMED_WAITING)

  private val threads = ManagementFactory.getThreadMXBean

  private def processorNanos(thread: Thread): Long =
    if threads.isThreadCpuTimeSupported && threads.isThreadCpuTimeEnabled then
      threads.getThreadCpuTime(thread.threadId)
    else -1
