package skein.vtime

import scala.concurrent.duration.FiniteDuration

/** Counts of a run: tasks (an actor's turn or a future's callback), timers that fired, and distinct times
  * visited.
  */
final case class RunCounts(tasks: Long, timers: Long, instants: Long)

/** A run that ended normally. Duration and counts are those at the completion of the future. */
final case class Finished[+A](value: A, duration: FiniteDuration, counts: RunCounts)
