package skein.vtime

import scala.concurrent.duration.FiniteDuration

/** What ran: tasks (an actor's turn or a future's callback), timers that fired, and distinct times visited.
  */
final case class RunCounts(tasks: Long, timers: Long, instants: Long)

/** A run that ended well. Duration and counts are those at the moment the future was completed. */
final case class Finished[+A](value: A, duration: FiniteDuration, counts: RunCounts)
