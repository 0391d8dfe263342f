package skein.environment

/** Some of a batch's environments, which are stepped together. Mutable; one thread at a time. */
private trait EnvironmentGroup extends AutoCloseable:

  /** Every environment begins anew.
    *
    * @param newSeeds of the whole batch; a negative one: the environment goes on with its own
    */
  def reset(newSeeds: Array[Long]): Unit

  /** Those of the mask begin anew. */
  def reset(newSeeds: Array[Long], mask: Array[Boolean]): Unit

  /** An environment whose action is not finite, or −1. */
  def misfit(): Int

  /** An environment that has ended and was not reset, or −1. */
  def ended: Int

  /** One step of every environment. */
  def step(): Unit

  def close(): Unit = ()

private object EnvironmentGroup:
  val CaptureReward = 10f

  /** Times of scores are floats. */
  val Tolerance = 1e-4f
