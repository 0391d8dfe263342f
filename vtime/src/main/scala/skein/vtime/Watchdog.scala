package skein.vtime

import java.lang.Thread.State
import scala.concurrent.duration.*

/** Ends a run whose thread stands still, waiting in one task for a lock, a latch or an answer that nobody on the loop can
  * give. Looks twice, half of `patience` (real time) apart.
  */
private final class Watchdog(loop: Loop, patience: FiniteDuration):
  private val watcher = Thread.ofVirtual.start(() => watch())

  /** From here on, the loop's thread may wait as long as it likes. */
  def stop(): Unit = watcher.interrupt()

  private def watch(): Unit =
    try
      var before = Option.empty[Long]
      while true do
        Thread.sleep((patience / 2).toMillis)
        val waiting = Watchdog.waiting.contains(loop.thread.getState)
        if waiting && before.contains(loop.begun) then
          val culprit = Loop.Culprit()
          culprit.setStackTrace(loop.thread.getStackTrace)
          loop.fail(Problem.Stuck(patience), culprit): Unit
          loop.thread.interrupt()
        before = Option.when(waiting)(loop.begun)
    catch case _: InterruptedException => ()

private object Watchdog:
  private val waiting = Set(State.BLOCKED, State.WAITING, State.TIMED_WAITING)
