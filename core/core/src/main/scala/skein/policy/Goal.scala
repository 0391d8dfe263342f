package skein.policy

/** Provides a planner with the position that a [[Policy]] wants its vehicle to reach, so that the planner can
  * decide instead of the policy. While plans decide, the policy's memory does not change.
  */
trait Goal:

  /** The position, north and east, m, where the vehicle should be after `aheadS` if it were alone. */
  def wanted(seen: Observation, aheadS: Double): (Double, Double)

  /** Maximum commanded speed, m/s, also in plans. */
  def mostMps: Double

  /** The smallest separation allowed, m; 0 for no limit. */
  def minimumM: Double = 0
