package skein.hil

import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.Airframe

/** Error-free readings of a vehicle's sensors.
  *
  * @param at sampling time, on the simulator's clock
  * @param up time since the simulator's start: the clock of autopilots
  * @param kinematics position and motion in the vehicle's own NED frame, whose origin is its start
  * @param accelerationNed m/s², zero for a vehicle at rest
  * @param place the vehicle's position on the globe
  * @param pressurePa pressure of the air, Pa
  * @param temperatureK temperature of the air, K
  * @param jumped whether it was moved to another place, or back to its start, since the last sensor reading
  */
final case class SensorTruth(
    at: Instant,
    up: Span,
    kinematics: Kinematics,
    accelerationNed: Vector3,
    place: GeoLocation,
    pressurePa: Double,
    temperatureK: Double,
    jumped: Boolean = false
):
  /** Specific force as an accelerometer measures it, FRD, m/s²: (0, 0, −9.81) at rest. */
  def specificForceFrd: Vector3 =
    kinematics.orientation.toBody(accelerationNed - Vector3(0, 0, Airframe.Gravity))
