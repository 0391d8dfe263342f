package skein.search

import skein.optimise.{RunningStats, SearchState}

/** What a search came to, measured on episodes that it never met.
  *
  * @param fresh of the best candidate
  * @param baseline of what it is held against, on the same episodes
  */
final case class Found(state: SearchState, best: Vector[Double], fresh: RunningStats, baseline: RunningStats)
