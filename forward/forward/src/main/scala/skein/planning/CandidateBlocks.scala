package skein.planning

import skein.lanes.LaneSupport

/** Makes the fastest blocks that the JVM can fly. */
private[planning] object CandidateBlocks:

  /** By lanes where the JVM has the vector module, else one after the other. */
  def apply(steps: Int): CandidateBlock = if isFast then PlanKernel(steps) else ScalarBlock(steps)

  def isFast: Boolean = LaneSupport.present.isRight
