package skein.loop

import skein.policy.Yaw
import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.{Guidance, PathFollowing, Setpoint}

/** [[skein.policy.Action.Position]] as AirSim executes it, for a prediction: along the straight line from the
  * vehicle's position. AirSim's line begins where the command arrived; the two differ by the vehicle's
  * deviation since.
  */
final private[loop] case class PositionGuidance(positionNed: Vector3, speed: MetresPerSecond, yaw: Yaw)
    extends Guidance:
  import PositionGuidance.turned

  private val lookaheadM = PathFollowing.lookaheadM(speed.value, isAdaptive = true)

  val period: Option[Span] = Some(PathFollowing.Period)

  def setpoint(now: => Kinematics): Setpoint =
    val way      = positionNed - now.positionNed
    val aim      = way * (lookaheadM / way.norm).min(1)
    val velocity = PathFollowing.velocityNed(aim, speed.value)
    turned(Setpoint.velocity(velocity.x, velocity.y, velocity.z), yaw, aim)

private[loop] object PositionGuidance:

  /** Adds the yaw that AirSim commands for a vehicle that moves along `travelNed` (`adjustYaw`). */
  def turned(setpoint: Setpoint, yaw: Yaw, travelNed: Vector3): Setpoint = yaw match
    case Yaw.Towards(heading)                                            => setpoint.withYaw(heading.value)
    case Yaw.Turning(rate)                                               => setpoint.withYawRate(rate)
    case Yaw.Forward if travelNed.norm > PathFollowing.DistanceAccuracyM =>
      setpoint.withYaw(StrictMath.atan2(travelNed.y, travelNed.x))
    case Yaw.Still | Yaw.Forward => setpoint
