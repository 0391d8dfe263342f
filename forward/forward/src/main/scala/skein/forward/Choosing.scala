package skein.forward

import skein.policy.*
import skein.units.*

/** Requests a horizontal velocity at the altitude of its vehicle's start from a policy of any kind, as
  * forward simulation requires. Mutable: it holds the policy's memory.
  *
  * @param regardsYaw whether the vehicle's motion depends on a commanded yaw
  */
private[skein] final class Choosing(agent: RolloutAgent, regardsYaw: Boolean):
  import Choosing.Chosen
  private val policy      = agent.policy
  private var memory: Any = ()
  private def whose       = OwnFailure.named("policy", policy)
  private def own         = memory.asInstanceOf[policy.Memory]

  def start(): Unit = memory = OwnFailure.told(whose)(policy.start)

  /** Decides on an observation.
    *
    * @throws OwnFailure if the policy throws, or its action is not supported by forward simulation
    */
  def choose(seen: Observation): Chosen =
    val (action, next) = OwnFailure.told(whose)(policy.choose(seen, own))
    memory = next
    def holds(yaw: Yaw) = yaw == Yaw.Still || !regardsYaw
    action match
      case Action.Along(heading, speed, seen.startDown, yaw) if holds(yaw) =>
        val (cos, sin) = (StrictMath.cos(heading.value), StrictMath.sin(heading.value))
        Chosen(heading.value, speed.value, speed.value * cos, speed.value * sin)
      case Action.VelocityAt(north, east, seen.startDown, yaw)
          if north.isFinite && east.isFinite && holds(yaw) =>
        Chosen(action.headingRad(seen.headingRad), action.speed.value, north, east)
      case other => throw OwnFailure(
          whose,
          s"decided for $other; forward simulation flies velocities at the altitude of the vehicle's start " +
            s"(${seen.startDown.value} m down)${if regardsYaw then ", without turning" else ""}"
        )

private[skein] object Choosing:
  /** A velocity, m/s, with the heading and speed that represent it for policies of headings. */
  final case class Chosen(headingRad: Double, speedMps: Double, northMps: Double, eastMps: Double)
