package skein.forward

import skein.policy.*
import skein.units.*

/** Asks a policy of any kind for the action of a vehicle. Mutable: it holds the policy's memory.
  *
  * @param by how the vehicle responds
  */
private[skein] final class Choosing(agent: RolloutAgent, by: VelocityResponse):
  import Choosing.Chosen
  private val policy      = agent.policy
  private var memory: Any = ()
  private def whose       = OwnFailure.named("policy", policy)
  private def own         = memory.asInstanceOf[policy.Memory]

  def start(): Unit = memory = OwnFailure.told(whose)(policy.start)

  /** Decides on an observation.
    *
    * @throws OwnFailure if the policy throws, or the vehicle does not perform its action
    */
  def choose(seen: Observation): Chosen =
    val (action, next) = OwnFailure.told(whose)(policy.choose(seen, own))
    memory = next
    def holds(yaw: Yaw) = yaw == Yaw.Still || !by.regardsYaw
    action match
      case Action.Along(heading, speed, seen.startDown, yaw) if holds(yaw) =>
        val (cos, sin) = (StrictMath.cos(heading.value), StrictMath.sin(heading.value))
        Chosen(heading.value, speed.value, speed.value * cos, speed.value * sin, None)
      case Action.VelocityAt(north, east, seen.startDown, yaw)
          if north.isFinite && east.isFinite && holds(yaw) =>
        Chosen(action.headingRad(seen.headingRad), action.speed.value, north, east, None)
      case other if by.performs(other) =>
        val (north, east) = action.byVelocity match
          case Action.Velocity(velocity, _)         => (velocity.x, velocity.y)
          case Action.VelocityAt(north, east, _, _) => (north, east)
          case _                                    => (0.0, 0.0)
        Chosen(action.headingRad(seen.headingRad), action.speed.value, north, east, Some(other))
      case other => throw OwnFailure(
          whose,
          s"decided for $other; this vehicle flies velocities at the altitude of its start " +
            s"(${seen.startDown.value} m down)${if by.regardsYaw then ", without turning" else ""}"
        )

private[skein] object Choosing:
  /** A velocity, m/s, with the heading and speed that represent it for policies of headings.
    *
    * @param action what the vehicle performs, unless it is this velocity at the altitude of its start
    */
  final case class Chosen(
      headingRad: Double,
      speedMps: Double,
      northMps: Double,
      eastMps: Double,
      action: Option[Action]
  )
