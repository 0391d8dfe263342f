package skein.vtime

import java.lang.Thread.State
import java.lang.management.ManagementFactory
import scala.concurrent.duration.*

/** Ends a run whose thread stands still: it waits in one task for a lock, a latch or an answer that the loop
  * cannot provide. Another thread cannot end a task that computes; this is only reported, once. Checks every
  * half of `patience` (real time).
  *
  * @param begun number of tasks that the thread has begun
  * @param onEndless called with the stack of a task that does not end
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

  /** Stops watching; from now on the loop's thread may wait without a limit. */
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

  /** One observation of the loop's thread.
    *
    * @param waits whether the thread waits now
    * @param begun number of tasks begun so far
    * @param processorNanos processor time so far; -1 where the JVM does not report it
    */
  final case class Look(waits: Boolean, begun: Long, processorNanos: Long)

  val LooksNeeded = 3

  /** Whether the thread stands still. On a busy machine a working thread may be observed waiting repeatedly,
    * for example while classes load: a thread that used the processor since the previous observation does not
    * stand still.
    */
  def standsStill(looks: Seq[Look]): Boolean =
    looks.size >= LooksNeeded && looks.forall(look => look.waits && look == looks.head)

  /** Whether one task used the processor for most of the time between the observations. */
  def isEndless(looks: Seq[Look], patience: FiniteDuration): Boolean =
    looks.size >= LooksNeeded && looks.forall(_.begun == looks.head.begun) &&
      looks.last.processorNanos - looks.head.processorNanos > patience.toNanos / 2

  private val waiting = Set(State.BLOCKED, State.WAITING, State.TIMED_WAITING)

  private val threads = ManagementFactory.getThreadMXBean

  /** Processor time of a thread so far; -1 where the JVM does not report it. */
  def processorNanos(thread: Thread): Long =
    if threads.isThreadCpuTimeSupported && threads.isThreadCpuTimeEnabled then
      threads.getThreadCpuTime(thread.threadId)
    else -1
