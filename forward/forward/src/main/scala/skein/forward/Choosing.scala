package skein.forward

import skein.policy.*
import skein.units.*

/** Asks a policy of any kind for a horizontal velocity at the altitude of its vehicle's start: what forward
  * simulation flies. Mutable: it holds what the policy remembers.
  *
  * @param regardsYaw whether the vehicle flies otherwise when it is told to turn
  */
private[skein] final class Choosing(agent: RolloutAgent, regardsYaw: Boolean):
  import Choosing.Chosen
  private val policy      = agent.policy
  private var memory: Any = ()
  private def whose       = OwnFailure.named("policy", policy)
  private def own         = memory.asInstanceOf[policy.Memory]

  /** Before the first decision. */
  def start(): Unit = memory = OwnFailure.told(whose)(policy.start)

  /** @throws OwnFailure if the policy throws, or decides for what forward simulation does not fly
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
  /** A velocity, m/s, and the heading and speed that stand for it where others ask for them. */
  final case class Chosen(headingRad: Double, speedMps: Double, northMps: Double, eastMps: Double)
