package skein.search

import skein.optimise.{RunningStats, SearchState}

/** A search's result, evaluated on episodes that the search did not use.
  *
  * @param fresh statistics of the best candidate
  * @param baseline statistics of the baseline, on equal episodes
  */
final case class Found(state: SearchState, best: Vector[Double], fresh: RunningStats, baseline: RunningStats):

  /** A warning if the 95 % intervals of the best and the baseline do not separate them. */
  def doubt(against: String): Option[String] =
    Option.when((fresh.mean - baseline.mean).abs <= fresh.halfWidth95 + baseline.halfWidth95)(
      s"the intervals of the best and of $against overlap: ${fresh.count} episodes do not show which is better"
    )
