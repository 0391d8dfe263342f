package skein.planning

/** Makes the fastest blocks that the JVM can fly. */
private[planning] object CandidateBlocks:
  private lazy val hasVectors = ModuleLayer.boot().findModule("jdk.incubator.vector").isPresent

  /** By lanes where the JVM has the vector module, else one after the other. */
  def apply(steps: Int): CandidateBlock = if hasVectors then PlanKernel(steps) else ScalarBlock(steps)

  def isFast: Boolean = hasVectors
