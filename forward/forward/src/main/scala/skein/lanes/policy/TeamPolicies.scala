package skein.lanes.policy

import skein.fusion.SensorModel
import skein.policy.Policy

/** How the vehicles of a team decide by SIMD. Teams of one form differ in numbers alone. */
private[lanes] trait TeamPolicies:
  def count: Int

  def inSpace: Boolean

  /** Whether decisions need more than readings and their own times. */
  def needsMore: Boolean

  /** By vehicle, the camera that is its only knowledge of its one opponent. */
  def eyes: Map[Int, SensorModel]

  /** Why no GPU flies them; None if one does. */
  def refusedByGpu: Option[String]

  /** Number of candidates with shared episodes that take no longer than one. */
  def sideBySide: Int

  /** The numbers by which a vehicle's policy differs from others of its form. */
  def numbersOf(self: Int, policy: Policy): PolicyNumbers

/** The numbers of one vehicle's policy in a world.
  *
  * @param parameters of its form
  * @param memory before its first decision
  */
private[lanes] final case class PolicyNumbers(parameters: Array[Double], memory: Array[Double])
