package skein.planning

import skein.lanes.LaneSupport

/** Makes the fastest block of candidates that the JVM supports. */
private[planning] object CandidateBlocks:

  /** A SIMD block if the JVM has the vector module, else a scalar one. */
  def apply(steps: Int): CandidateBlock = if isFast then PlanKernel(steps) else ScalarBlock(steps)

  def isFast: Boolean = LaneSupport.present.isRight
