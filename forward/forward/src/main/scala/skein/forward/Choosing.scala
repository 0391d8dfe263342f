package skein.forward

import skein.policy.*
import skein.units.*

/** Evaluates a policy of any kind for one vehicle. Mutable: it contains the policy's memory.
  *
  * @param by how the vehicle responds to commands
  */
private[skein] final class Choosing(agent: RolloutAgent, by: VelocityResponse):
  private val policy      = agent.policy
  private var memory: Any = ()
  private def whose       = OwnFailure.named("policy", policy)
  private def own         = memory.asInstanceOf[policy.Memory]

  def start(): Unit = memory = OwnFailure.told(whose)(policy.start)

  /** Chooses the action for an observation.
    *
    * @throws OwnFailure if the policy throws, or chooses an action that the vehicle does not perform
    */
  def choose(seen: Observation): Action =
    val (action, next) = OwnFailure.told(whose)(policy.choose(seen, own))
    memory = next
    def holds(yaw: Yaw) = yaw == Yaw.Still || !by.regardsYaw
    val isLevel         = action match
      case Action.Along(_, _, seen.startDown, yaw)             => holds(yaw)
      case Action.VelocityAt(north, east, seen.startDown, yaw) =>
        north.isFinite && east.isFinite && holds(yaw)
      case _ => false
    if isLevel || by.performs(action) then action
    else
      throw OwnFailure(
        whose,
        s"decided for $action; this vehicle flies velocities at the altitude of its start " +
          s"(${seen.startDown.value} m down)${if by.regardsYaw then ", without turning" else ""}"
      )
