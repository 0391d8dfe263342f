package skein.planning

import skein.lanes.LaneSupport

/** Creates the fastest kind of block that the JVM supports. */
private[planning] object CandidateBlocks:

  /** A SIMD block if the JVM has the vector module, else a scalar block. */
  def apply(steps: Int): CandidateBlock = if isFast then PlanKernel(steps) else ScalarBlock(steps)

  def isFast: Boolean = LaneSupport.present.isRight
