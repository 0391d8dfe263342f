package skein.simulator

import skein.signal.Kinematics
import skein.units.*

/** Holds a position with the sticks of a multirotor in angle mode: horizontally by angles, the altitude by
  * the throttle. A stick at its end is [[StickPilot.MostTiltDeg]] and [[StickPilot.MostYawRateDeg]].
  */
private final class StickPilot(goalNed: Vector3):
  import StickPilot.*

  private var integral = 0.0

  /** Roll to the right, pitch forwards and yaw to the right from −1 to 1, throttle from 0 to 1. */
  def sticks(seen: Kinematics, dtS: Double): (roll: Double, pitch: Double, throttle: Double, yaw: Double) =
    val yaw   = seen.orientation.yawRad
    val off   = goalNed - seen.positionNed
    val v     = seen.velocityNed
    val slow  = 1 / math.max(1.0, off.norm / 2)
    val north = 0.9 * off.x * slow - 1.6 * v.x
    val east  = 0.9 * off.y * slow - 1.6 * v.y
    val front = north * math.cos(yaw) + east * math.sin(yaw)
    val right = -north * math.sin(yaw) + east * math.cos(yaw)
    // Up, m/s².
    val up = 2.0 * -(off.z.max(-1.5).min(1.5)) + 2.4 * v.z
    // Not while it climbs.
    if off.z.abs < 1 then integral = (integral - 0.8 * dtS * off.z).max(-2).min(2)
    (
      roll = math.toDegrees(math.atan2(right, GravityMps2)) / MostTiltDeg,
      pitch = math.toDegrees(math.atan2(front, GravityMps2)) / MostTiltDeg,
      throttle = HoverThrottle + (up + integral) / LiftPerThrottle,
      yaw = -math.toDegrees(yaw) / MostYawRateDeg
    )

private object StickPilot:
  val MostTiltDeg    = 30
  val MostYawRateDeg = 200

  private val GravityMps2     = 9.8
  private val HoverThrottle   = 0.58
  private val LiftPerThrottle = 16.5
