package skein.environment

/** Some of a batch's environments, which are stepped together. Mutable; one thread at a time. */
private trait EnvironmentGroup extends AutoCloseable:

  /** Resets every environment.
    *
    * @param newSeeds of the whole batch; a negative one continues the environment's own sequence
    */
  def reset(newSeeds: Array[Long]): Unit

  /** Resets the environments of the mask, with their seeds. */
  def reset(newSeeds: Array[Long], mask: Array[Boolean]): Unit

  /** An environment whose action is not finite, or −1. */
  def misfit(): Int

  /** An environment that has ended and was not reset, or −1. */
  def ended: Int

  def step(): Unit

  def close(): Unit = ()

private object EnvironmentGroup:
  val CaptureReward = 10f

  /** Tolerance for comparing times of scores, which are 32-bit floats, s. */
  val Tolerance = 1e-4f
