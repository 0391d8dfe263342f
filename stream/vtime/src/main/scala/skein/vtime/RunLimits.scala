package skein.vtime

import scala.concurrent.duration.*

/** Limits of a run.
  *
  * @param duration of virtual time
  * @param tasksPerInstant tasks that may run without time advancing
  * @param processorPerInstant processor time that very many tasks may take without time advancing: one task
  *   of a stream may handle a thousand elements
  * @param standstill real time for which the loop's thread may wait in one task
  */
final case class RunLimits(
    duration: FiniteDuration = 1.day,
    tasksPerInstant: Long = 1_000_000,
    processorPerInstant: FiniteDuration = 3.seconds,
    standstill: FiniteDuration = 10.seconds
):
  require(
    duration > Duration.Zero && tasksPerInstant > 0 && processorPerInstant > Duration.Zero &&
      standstill > 1.milli,
    s"limits must be positive: $this"
  )
