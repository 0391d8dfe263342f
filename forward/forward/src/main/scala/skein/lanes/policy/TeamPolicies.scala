package skein.lanes.policy

import skein.forward.RolloutAgent
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

  /** Why no GPU flies such a team; None if one does. */
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

/** The numbers by which a vehicle in one world differs from those of other worlds: few objects, since each
  * world reads those of its own.
  *
  * @param policy its parameters, then its memory before the first decision
  */
private[lanes] final class VehicleNumbers(agent: RolloutAgent, numbers: PolicyNumbers):
  val northM: Float        = agent.startX.toFloat
  val eastM: Float         = agent.startY.toFloat
  val downM: Float         = agent.altitudeDownM.toFloat
  val cos: Float           = StrictMath.cos(agent.startHeadingRad).toFloat
  val sin: Float           = StrictMath.sin(agent.startHeadingRad).toFloat
  val speedMps: Float      = agent.speed.toFloat
  val parameters: Int      = numbers.parameters.length
  val policy: Array[Float] = (numbers.parameters ++ numbers.memory).map(_.toFloat)
