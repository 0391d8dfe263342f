package skein.loop

import skein.policy.{Action, Fleet, Yaw}
import skein.units.*
import skein.vehicle.{Guidance, Setpoint}

/** What of an action stands for it where headings and speeds are asked for, and what the flight controller
  * makes of it.
  */
private object Acting:
  import PositionGuidance.turned

  /** Rad: where it flies, or else where it looks; the heading before where it says neither. */
  def headingRad(action: Action, beforeRad: Double): Double = action match
    case Action.Velocity(velocity, _)         => along(velocity.x, velocity.y, beforeRad)
    case Action.VelocityAt(north, east, _, _) => along(north, east, beforeRad)
    case Action.Turn(Yaw.Towards(heading))    => heading.value
    case Action.Attitude(_, _, yaw, _)        => yaw.value
    case Action.Position(_, _, _) | Action.Turn(_) | Action.Hover | Action.Land => beforeRad

  /** Horizontal. */
  def speed(action: Action): MetresPerSecond = MetresPerSecond(action match
    case Action.Velocity(velocity, _)         => StrictMath.hypot(velocity.x, velocity.y)
    case Action.VelocityAt(north, east, _, _) => StrictMath.hypot(north, east)
    case _                                    => 0)

  /** The command as a model of the vehicle takes it, for a prediction. */
  def guidance(action: Action): Guidance = action match
    case Action.Velocity(velocity, yaw) =>
      turned(Setpoint.velocity(velocity.x, velocity.y, velocity.z), yaw, velocity)
    case Action.VelocityAt(north, east, down, yaw) =>
      turned(Setpoint.velocityZ(north, east, down.value), yaw, Vector3(north, east, 0))
    case Action.Position(position, speed, yaw)     => PositionGuidance(position, speed, yaw)
    case Action.Turn(yaw)                          => turned(Setpoint.velocity(0, 0, 0), yaw, Vector3.Zero)
    case Action.Attitude(roll, pitch, yaw, thrust) =>
      Setpoint.anglesThrottle(roll.value, pitch.value, yaw.value, thrust)
    case Action.Hover => Setpoint.velocity(0, 0, 0)
    case Action.Land  => Setpoint.velocity(0, 0, LandingMps)

  /** A move that was sent, as a model of the vehicle takes it. */
  def guidance(fleet: Fleet, move: SentCommand): Guidance =
    val agent = fleet.agents(move.vehicle)
    move.action.fold {
      val velocity = agent.velocityNed(move.headingRad, move.speed)
      Setpoint.velocityZ(velocity.x, velocity.y, agent.startPositionNed.z)
    }(guidance)

  /** What a vehicle is told: the action, or for a heading the velocity along it, at the altitude of the
    * start.
    */
  def action(fleet: Fleet, decision: Decision): Action =
    decision.action.getOrElse:
      val agent    = fleet.agents(decision.vehicle)
      val velocity = agent.velocityNed(decision.heading.value, decision.speed)
      Action.VelocityAt(velocity.x, velocity.y, Metres(agent.startPositionNed.z))

  private def along(northMps: Double, eastMps: Double, beforeRad: Double) =
    if StrictMath.hypot(northMps, eastMps) < 1e-9 then beforeRad else StrictMath.atan2(eastMps, northMps)

  /** AirSim's. */
  private val LandingMps = 0.2
