package skein.search

import skein.optimise.{RunningStats, SearchState}

/** What a search came to, measured on episodes that it never met.
  *
  * @param fresh of the best candidate
  * @param baseline of what it is held against, on the same episodes
  */
final case class Found(state: SearchState, best: Vector[Double], fresh: RunningStats, baseline: RunningStats):

  /** What is to be known where the best and the baseline cannot be told apart by their intervals of 95 %. */
  def doubt(against: String): Option[String] =
    Option.when((fresh.mean - baseline.mean).abs <= fresh.halfWidth95 + baseline.halfWidth95)(
      s"the intervals of the best and of $against overlap: ${fresh.count} episodes do not tell which is better"
    )
