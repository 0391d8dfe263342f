package skein.ros

import skein.policy.{Action, ActionGuidance, Yaw}
import skein.port.VehicleError
import skein.ros.message.{Odometry, Twist, Vector3 as RosVector}
import skein.signal.Kinematics
import skein.units.{Quaternion, Span, Vector3}
import skein.vehicle.{GoTo, Guidance, Setpoint}

/** Converts odometry to motion in Skein's terms, and actions to the `cmd_vel` that performs them. */
object TwistCommand:
  /** Time after which a command is sent again. */
  val Every: Span = Span.ofMillis(50)

  /** Converts odometry to a motion in NED. Left says which values are not a motion. */
  def kinematics(odometry: Odometry): Either[String, Kinematics] =
    val (at, q) = (odometry.pose.pose.position, odometry.pose.pose.orientation)
    val twist   = odometry.twist.twist
    val norm    = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
    val enu     = Quaternion(q.w, q.x, q.y, q.z).normalized
    val motion  = Kinematics(
      RosFrames.swapWorld(Vector3(at.x, at.y, at.z)),
      RosFrames.swapWorld(enu.toWorld(Vector3(twist.linear.x, twist.linear.y, twist.linear.z))),
      RosFrames.toNed(enu),
      RosFrames.swapBody(Vector3(twist.angular.x, twist.angular.y, twist.angular.z))
    )
    Either.cond(
      motion.isFinite && math.abs(norm - 1) < 0.1,
      motion,
      s"expected finite numbers and a unit quaternion, got the position ${at.x}, ${at.y}, ${at.z} and a " +
        s"quaternion of the squared length $norm"
    )

  /** The velocity in ENU, and the turn about its z axis, that perform an action from a motion. Altitudes and
    * headings are reached by feedback: each call answers for the present motion.
    */
  def of(action: Action, now: Kinematics): Either[VehicleError, Twist] =
    def velocity(ned: Vector3, yaw: Yaw) = Right(twist(ned, turn(yaw, ned, now.orientation.yawRad)))
    action match
      case Action.Velocity(ned, yaw)                 => velocity(ned, yaw)
      case Action.VelocityAt(north, east, down, yaw) =>
        val vertical = bounded(PerMetre * (down.value - now.positionNed.z), ClimbMps)
        velocity(Vector3(north, east, vertical), yaw)
      case along: Action.Along                => of(along.byVelocity, now)
      case Action.Position(place, speed, yaw) =>
        velocity(GoTo.velocityNed(now.positionNed, now.velocityNed, place, speed), yaw)
      case Action.Turn(yaw)            => velocity(Vector3.Zero, yaw)
      case Action.Hover                => velocity(Vector3.Zero, Yaw.Still)
      case Action.Land                 => velocity(Vector3(0, 0, LandingMps), Yaw.Still)
      case Action.Attitude(_, _, _, _) =>
        Left(
          VehicleError.Unsupported("expected an action by velocity or position, cmd_vel takes no attitude")
        )

  /** How a vehicle performs an action by commands that are sent again every [[Every]], for predictions. */
  def guidance(action: Action): Guidance = ByTwists(action)

  private final case class ByTwists(action: Action) extends Guidance:
    val period: Option[Span] = Some(Every)

    def setpoint(now: => Kinematics): Setpoint =
      val performed = of(action, now).fold(
        _ => action,
        twist =>
          val v = twist.linear
          Action.Velocity(RosFrames.swapWorld(Vector3(v.x, v.y, v.z)), Yaw.Turning(-twist.angular.z))
      )
      ActionGuidance.of(performed).setpoint(now)

  private def twist(ned: Vector3, turnRadps: Double) =
    val enu = RosFrames.swapWorld(ned)
    Twist(RosVector(enu.x, enu.y, enu.z), RosVector(0, 0, -turnRadps))

  /** The rate by which to turn, rad/s, clockwise seen from above. */
  private def turn(yaw: Yaw, travelNed: Vector3, headingRad: Double): Double = yaw match
    case Yaw.Turning(rate)    => rate
    case Yaw.Towards(heading) => towards(heading.value, headingRad)
    case Yaw.Forward if StrictMath.hypot(travelNed.x, travelNed.y) > ForwardMps =>
      towards(StrictMath.atan2(travelNed.y, travelNed.x), headingRad)
    case Yaw.Forward | Yaw.Still => 0

  private def towards(goalRad: Double, headingRad: Double) =
    bounded(PerRadian * StrictMath.IEEEremainder(goalRad - headingRad, 2 * math.Pi), TurnRadps)

  private def bounded(value: Double, most: Double) = value.max(-most).min(most)

  private val PerMetre   = 1.0
  private val ClimbMps   = 3.0
  private val PerRadian  = 2.0
  private val TurnRadps  = 1.5
  private val ForwardMps = 0.5
  private val LandingMps = 0.3
