package skein.policy

/** What a planner needs of a [[Policy]] to decide instead of it: the position that its vehicle should reach.
  * While plans decide, the policy's memory does not change.
  */
trait Goal:

  /** The position, north and east, m, that it would choose for a time ahead if it were alone. */
  def wanted(seen: Observation, aheadS: Double): (Double, Double)

  /** Limit of the commanded speed, m/s; never exceeded by a plan. */
  def mostMps: Double

  /** The smallest separation allowed, m; 0: none. */
  def minimumM: Double = 0
