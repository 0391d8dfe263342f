package skein.policy

import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.{Guidance, PathFollowing, Setpoint}

/** Converts actions to goals of AirSim's flight controller. */
object ActionGuidance:
  def of(action: Action): Guidance = action match
    case Action.Velocity(velocity, yaw) =>
      turned(Setpoint.velocity(velocity.x, velocity.y, velocity.z), yaw, velocity)
    case Action.VelocityAt(north, east, down, yaw) =>
      turned(Setpoint.velocityZ(north, east, down.value), yaw, Vector3(north, east, 0))
    case along: Action.Along                       => of(along.byVelocity)
    case Action.Position(position, speed, yaw)     => PositionGuidance(position, speed, yaw)
    case Action.Turn(yaw)                          => turned(Setpoint.velocity(0, 0, 0), yaw, Vector3.Zero)
    case Action.Attitude(roll, pitch, yaw, thrust) =>
      Setpoint.anglesThrottle(roll.value, pitch.value, yaw.value, thrust)
    case Action.Hover => Setpoint.velocity(0, 0, 0)
    case Action.Land  => Setpoint.velocity(0, 0, LandingMps)

  /** Speed of descent with which AirSim lands, m/s. */
  private val LandingMps = 0.2

  /** Adds the yaw that AirSim commands to a vehicle that moves along `travelNed` (`adjustYaw`). */
  private[skein] def turned(setpoint: Setpoint, yaw: Yaw, travelNed: Vector3): Setpoint = yaw match
    case Yaw.Towards(heading)                                            => setpoint.withYaw(heading.value)
    case Yaw.Turning(rate)                                               => setpoint.withYawRate(rate)
    case Yaw.Forward if travelNed.norm > PathFollowing.DistanceAccuracyM =>
      setpoint.withYaw(StrictMath.atan2(travelNed.y, travelNed.x))
    case Yaw.Still | Yaw.Forward => setpoint

  /** [[Action.Position]] as AirSim executes it: along the straight line from the vehicle's position. In
    * AirSim, the line begins at the position at the command's arrival; the two differ by the vehicle's
    * deviation from the line since then.
    */
  private final case class PositionGuidance(positionNed: Vector3, speed: MetresPerSecond, yaw: Yaw)
      extends Guidance:
    private val lookaheadM = PathFollowing.lookaheadM(speed.value, isAdaptive = true)

    val period: Option[Span] = Some(PathFollowing.Period)

    def setpoint(now: => Kinematics): Setpoint =
      val way      = positionNed - now.positionNed
      val aim      = way * (lookaheadM / way.norm).min(1)
      val velocity = PathFollowing.velocityNed(aim, speed.value)
      turned(Setpoint.velocity(velocity.x, velocity.y, velocity.z), yaw, aim)
