package skein.ros

import skein.policy.{Action, Yaw}
import skein.ros.message.*
import skein.ros.message.Vector3 as RosVector
import skein.signal.Kinematics
import skein.units.{Expect, MetresPerSecond, Quaternion, Radians, Span, Vector3}
import skein.vehicle.GoTo

/** Converts ROS commands to actions. Left says what was expected, and what was received. */
private[ros] object VehicleCommands:
  /** Duration of a velocity after its arrival, on the simulator's clock. */
  val VelocityLasts: Span = Span.ofSeconds(0.5)

  /** Maximum speed of a vehicle's flight to a pose. */
  val Cruise: MetresPerSecond = MetresPerSecond(5)

  /** Flies with a velocity and turns at a rate. In the vehicle's frame, front and left are level and turn
    * with its heading; in the world's they are east and north. Up is up in both.
    *
    * @param frameId the vehicle's `NAME/base_link`, `base_link` or empty; or the world's `map`
    */
  def velocity(vehicle: String, frameId: String, twist: Twist): Either[String, Kinematics => Action] =
    val (wanted, turn) = (vector(twist.linear), Yaw.Turning(-twist.angular.z))
    for
      _      <- finite(Seq(wanted.x, wanted.y, wanted.z, twist.angular.z))
      action <- frameId match
        case VehicleMessages.World =>
          val ned = RosFrames.swapWorld(wanted)
          Right((_: Kinematics) => Action.Velocity(ned, turn))
        case "" | "base_link"                            => Right(inBody(wanted, turn))
        case own if own == VehicleMessages.body(vehicle) => Right(inBody(wanted, turn))
        case other                                       =>
          Left(
            s"expected the frame ${VehicleMessages.body(vehicle)} or ${VehicleMessages.World}, got '$other'"
          )
    yield action

  private def inBody(flu: Vector3, turn: Yaw)(now: Kinematics): Action =
    Action.Velocity(RosFrames.fromLevel(flu, now.orientation.yawRad), turn)

  /** Flies to a position, turns to the pose's heading, and stays there. An orientation of zeros sets no
    * heading.
    */
  def position(pose: PoseStamped): Either[String, Kinematics => Action] =
    val (at, q)  = (pose.pose.position, pose.pose.orientation)
    val rotation = Quaternion(q.w, q.x, q.y, q.z)
    val norm     = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z
    for
      _ <- finite(Seq(at.x, at.y, at.z, norm))
      _ <- Expect.that(Set("", VehicleMessages.World)(pose.header.frameId)):
        s"expected the frame ${VehicleMessages.World}, got '${pose.header.frameId}'"
    yield
      val yaw =
        if norm == 0 then Yaw.Still else Yaw.Towards(Radians(RosFrames.heading(rotation.normalized)))
      val goal = RosFrames.swapWorld(Vector3(at.x, at.y, at.z))
      now => Action.Velocity(GoTo.velocityNed(now.positionNed, now.velocityNed, goal, Cruise), yaw)

  private def finite(numbers: Seq[Double]) =
    Expect.that(numbers.forall(_.isFinite))(s"expected finite numbers, got ${numbers.mkString(", ")}")

  private def vector(v: RosVector) = Vector3(v.x, v.y, v.z)
