package skein.loop

import skein.policy.{Action, Fleet}
import skein.units.*
import skein.vehicle.{Guidance, Setpoint}

/** Converts actions to headings, speeds and model setpoints. */
private object Acting:
  import PositionGuidance.turned

  /** The command of an action for a vehicle model's prediction. */
  def guidance(action: Action): Guidance = action match
    case Action.Velocity(velocity, yaw) =>
      turned(Setpoint.velocity(velocity.x, velocity.y, velocity.z), yaw, velocity)
    case Action.VelocityAt(north, east, down, yaw) =>
      turned(Setpoint.velocityZ(north, east, down.value), yaw, Vector3(north, east, 0))
    case along: Action.Along                       => guidance(along.byVelocity)
    case Action.Position(position, speed, yaw)     => PositionGuidance(position, speed, yaw)
    case Action.Turn(yaw)                          => turned(Setpoint.velocity(0, 0, 0), yaw, Vector3.Zero)
    case Action.Attitude(roll, pitch, yaw, thrust) =>
      Setpoint.anglesThrottle(roll.value, pitch.value, yaw.value, thrust)
    case Action.Hover => Setpoint.velocity(0, 0, 0)
    case Action.Land  => Setpoint.velocity(0, 0, LandingMps)

  /** The command of a sent move for a vehicle model's prediction. */
  def guidance(fleet: Fleet, move: SentCommand): Guidance =
    val agent = fleet.agents(move.vehicle)
    move.action.fold {
      val velocity = agent.velocityNed(move.headingRad, move.speed)
      Setpoint.velocityZ(velocity.x, velocity.y, agent.startPositionNed.z)
    }(guidance)

  /** The action to command: the decided one, or for a heading the velocity along it, at the altitude of the
    * start.
    */
  def action(fleet: Fleet, decision: Decision): Action =
    decision.action.getOrElse:
      val agent    = fleet.agents(decision.vehicle)
      val velocity = agent.velocityNed(decision.heading.value, decision.speed)
      Action.VelocityAt(velocity.x, velocity.y, Metres(agent.startPositionNed.z))

  /** AirSim's speed of descent while landing, m/s. */
  private val LandingMps = 0.2
