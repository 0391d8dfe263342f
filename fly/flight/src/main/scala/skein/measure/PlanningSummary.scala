package skein.measure

import skein.record.Recording

/** How a flight's decisions were planned.
  *
  * @param candidates per plan
  * @param slices of all vehicles that were planned for together
  * @param tookMs from asking until the decision was there
  * @param missed deadlines at which nothing was ready
  * @param breached plans that could not keep within a hard limit
  */
final case class PlanningSummary(
    candidates: Distribution,
    slices: Distribution,
    tookMs: Distribution,
    missed: Int,
    breached: Int
)

object PlanningSummary:

  /** Absent where nothing was planned. */
  def of(recording: Recording): Option[PlanningSummary] =
    val plans = recording.planned
    for
      candidates <- Distribution.of(plans.map(_.candidates.toDouble))
      slices     <- Distribution.of(plans.map(_.slices.sum.toDouble))
      tookMs     <- Distribution.of(plans.map(_.took.toMillis))
    yield PlanningSummary(
      candidates,
      slices,
      tookMs,
      plans.count(_.candidates == 0),
      plans.count(_.breaches > 0)
    )
