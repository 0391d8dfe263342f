package skein.policy

import skein.units.*
import skein.vehicle.{Setpoint, YawMode}

/** Rounds actions to the precision of AirSim's wire: values are 32-bit floats, and yaws are in degrees. */
private[skein] object OnWire:
  def of(action: Action): Action = action match
    case Action.Velocity(velocity, yaw)            => Action.Velocity(of(velocity), yaw)
    case Action.VelocityAt(north, east, down, yaw) =>
      Action.VelocityAt(north.toFloat, east.toFloat, Metres(down.value.toFloat), yaw)
    case along: Action.Along                   => of(along.byVelocity)
    case Action.Position(position, speed, yaw) =>
      Action.Position(of(position), MetresPerSecond(speed.value.toFloat), yaw)
    case Action.Attitude(roll, pitch, yaw, thrust) =>
      def single(angle: Radians) = Radians(angle.value.toFloat)
      Action.Attitude(single(roll), single(pitch), single(yaw), thrust.toFloat)
    case other => other

  def of(setpoint: Setpoint): Setpoint =
    // Angles of an attitude are sent in radians.
    if setpoint.horizontal == skein.vehicle.HorizontalMode.Angles then setpoint
    else if setpoint.yaw == YawMode.Rate && setpoint.yawGoal == 0 then setpoint
    else setpoint.copy(yawGoal = math.toRadians(math.toDegrees(setpoint.yawGoal).toFloat))

  private def of(vector: Vector3) = Vector3(vector.x.toFloat, vector.y.toFloat, vector.z.toFloat)
