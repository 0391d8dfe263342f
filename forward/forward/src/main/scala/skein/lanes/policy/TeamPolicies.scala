package skein.lanes.policy

import skein.forward.RolloutAgent
import skein.fusion.SensorModel
import skein.policy.Policy

/** Decides for the vehicles of a team with SIMD. Teams of one form differ only in parameter values. */
private[lanes] trait TeamPolicies:
  def count: Int

  def inSpace: Boolean

  /** Whether decisions need more than the readings and the vehicles' own decision times. */
  def needsMore: Boolean

  /** Whether decisions depend on the time since the start. */
  def asksTime: Boolean

  /** The camera of each vehicle that knows its one opponent only through a camera. */
  def eyes: Map[Int, SensorModel]

  /** The reason why a GPU does not support such a team; None if it does. */
  def refusedByGpu: Option[String]

  /** Number of candidates with shared episodes that can be simulated in the time of one. */
  def sideBySide: Int

  /** The values that distinguish a vehicle's policy from others of its form. */
  def numbersOf(self: Int, policy: Policy): PolicyNumbers

/** The values that distinguish one vehicle's policy in a world from others of its form.
  *
  * @param parameters values of the form's parameters
  * @param memory components of the memory before the first decision
  */
private[lanes] final case class PolicyNumbers(parameters: Array[Double], memory: Array[Double])

/** The values that distinguish a vehicle from those of other worlds, in few objects, since every world reads
  * its own.
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
