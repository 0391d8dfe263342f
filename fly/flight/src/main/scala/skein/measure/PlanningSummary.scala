package skein.measure

import skein.record.Recording

/** Statistics of a flight's plans.
  *
  * @param candidates number of candidates per plan
  * @param slices number of slices per plan, of all searches and of all vehicles that were planned together
  * @param tookMs time from the request to the decision
  * @param missed number of deadlines without any result
  * @param breached number of plans that could not keep within a hard limit
  */
final case class PlanningSummary(
    candidates: Distribution,
    slices: Distribution,
    tookMs: Distribution,
    missed: Int,
    breached: Int
)

object PlanningSummary:

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
