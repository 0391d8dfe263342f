package skein.vtime

import scala.concurrent.duration.*

/** Limits of a run.
  *
  * @param duration maximum duration, in virtual time
  * @param tasksPerInstant maximum number of tasks that run without time advancing
  * @param processorPerInstant maximum processor time that very many tasks take without time advancing: one
  *   task of a stream may handle a thousand elements
  * @param standstill maximum real time for which the loop's thread waits in one task
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
