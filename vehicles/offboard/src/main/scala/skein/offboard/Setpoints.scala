package skein.offboard

import skein.mavlink.CommonDialect.Ignore.Acceleration
import skein.mavlink.CommonDialect.{Frame, Ignore}
import skein.mavlink.{Message, SetAttitudeTarget, SetPositionTargetLocalNed}
import skein.policy.{Action, Yaw}
import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.GoTo

/** Converts actions to MAVLink setpoint messages. */
private[offboard] object Setpoints:

  /** The setpoint message of an action; None for actions that are modes of the autopilot: hovering and
    * landing.
    *
    * @param state the vehicle's state, in its own frame
    * @param originNed origin of that frame, in the flight's
    */
  def of(action: Action, state: Kinematics, originNed: Vector3, system: Int): Option[Message] = action match
    case Action.Velocity(v, yaw) =>
      Some(local(system, Vector3.Zero, v, Ignore.Position | Acceleration, turn(yaw, v)))
    case Action.VelocityAt(north, east, down, yaw) =>
      val velocity = Vector3(north, east, 0)
      val at       = Vector3(0, 0, down.value - originNed.z)
      Some(local(system, at, velocity, Ignore.X | Ignore.Y | Ignore.Vz | Acceleration, turn(yaw, velocity)))
    case along: Action.Along                => of(along.byVelocity, state, originNed, system)
    case Action.Position(place, speed, yaw) =>
      val goal = place - originNed
      val way  = goal - state.positionNed
      // No setpoint states the speed towards a position: far from it, a velocity is sent instead.
      if way.norm > NearM then
        val velocity = GoTo.velocityNed(state.positionNed, state.velocityNed, goal, speed)
        Some(local(system, Vector3.Zero, velocity, Ignore.Position | Acceleration, turn(yaw, way)))
      else Some(local(system, goal, Vector3.Zero, Ignore.Velocity | Acceleration, turn(yaw, way)))
    case Action.Turn(yaw) =>
      Some(local(system, Vector3.Zero, Vector3.Zero, Ignore.Position | Acceleration, turn(yaw, Vector3.Zero)))
    case Action.Attitude(roll, pitch, yaw, thrust) =>
      val q = Quaternion.of(roll.value, pitch.value, yaw.value)
      Some(
        SetAttitudeTarget(0, system, 1, 7, Vector(q.w, q.x, q.y, q.z).map(_.toFloat), 0, 0, 0, thrust.toFloat)
      )
    case Action.Hover | Action.Land => None

  private val NearM      = 1.0
  private val ForwardMps = 0.5

  /** The type mask's bits for yaw, the yaw, rad, and the yaw rate, rad/s. A set bit makes the autopilot
    * ignore its field.
    */
  private def turn(yaw: Yaw, travelNed: Vector3): (mask: Int, yaw: Double, rate: Double) = yaw match
    case Yaw.Towards(heading) => (mask = Ignore.YawRate, yaw = heading.value, rate = 0.0)
    case Yaw.Turning(rate)    => (mask = Ignore.Yaw, yaw = 0.0, rate = rate)
    case Yaw.Forward if StrictMath.hypot(travelNed.x, travelNed.y) > ForwardMps =>
      (mask = Ignore.YawRate, yaw = StrictMath.atan2(travelNed.y, travelNed.x), rate = 0.0)
    case Yaw.Still | Yaw.Forward => (mask = Ignore.Yaw | Ignore.YawRate, yaw = 0.0, rate = 0.0)

  private def local(
      system: Int,
      at: Vector3,
      velocity: Vector3,
      ignored: Int,
      turn: (mask: Int, yaw: Double, rate: Double)
  ): Message = SetPositionTargetLocalNed(
    0,
    system,
    1,
    Frame.LocalNed,
    ignored | turn.mask,
    at.x.toFloat,
    at.y.toFloat,
    at.z.toFloat,
    velocity.x.toFloat,
    velocity.y.toFloat,
    velocity.z.toFloat,
    0,
    0,
    0,
    turn.yaw.toFloat,
    turn.rate.toFloat
  )
