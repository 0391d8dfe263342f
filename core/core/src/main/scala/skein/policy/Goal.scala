package skein.policy

/** What a planner needs to know of a [[Policy]] to decide in its place: where its vehicle is to be. While
  * plans decide, what the policy remembers stays as it was.
  */
trait Goal:

  /** Where it wants to be a time ahead, north and east, m, if it were alone. */
  def wanted(seen: Observation, aheadS: Double): (Double, Double)

  /** The fastest that is commanded, m/s. */
  def mostMps: Double

  /** The smallest separation allowed, m; 0: none. */
  def minimumM: Double = 0
