package skein.search

import skein.optimise.{Direction, RunningStats, SearchState}

/** A search's result, evaluated on episodes that the search did not use.
  *
  * @param fresh statistics of the best candidate
  * @param baseline statistics of the baseline, on equal episodes
  */
final case class Found(state: SearchState, best: Vector[Double], fresh: RunningStats, baseline: RunningStats):

  /** A warning if the episodes do not show that the best is better than the baseline. */
  def doubt(against: Baseline, direction: Direction): Option[String] =
    val gain = direction.sign * (baseline.mean - fresh.mean)
    if best == against.candidate then Some(s"nothing better than ${against.label} was found")
    else if gain.abs <= fresh.halfWidth95 + baseline.halfWidth95 then
      Some(
        s"the intervals of the best and of ${against.label} overlap: ${fresh.count} episodes do not show which " +
          "is better"
      )
    else
      Option.when(gain < 0):
        s"the best is worse than ${against.label} on these ${fresh.count} episodes: search with more --episodes"
