package skein.airsim

import skein.signal.Kinematics
import skein.units.*

/** A vehicle's place and orientation, world NED. */
final case class VehiclePose(positionNed: Vector3, orientation: Quaternion)

/** What the states of all kinds of vehicles have. */
trait VehicleStatus:
  def kinematics: Kinematics

  /** Whether its sensors have no reading now, so that `kinematics` are earlier ones. */
  def isMissing: Boolean

/** A multirotor's state as it estimates it itself, which for AirSim's default vehicle is the true state. */
final case class MultirotorStatus(kinematics: Kinematics, flying: Boolean, isMissing: Boolean = false)
    extends VehicleStatus

/** The last contact of a vehicle with another object.
  *
  * @param at time of the contact, on the simulator's clock
  * @param positionNed the vehicle's position at the contact, world, m
  * @param normalNed the surface's normal
  */
final case class Collision(at: Instant, positionNed: Vector3, normalNed: Vector3, objectName: String)

/** @param specificForceFrd acceleration less gravity, m/s²
  */
final case class ImuReading(orientation: Quaternion, angularVelocityFrd: Vector3, specificForceFrd: Vector3)

/** @param velocityNed m/s
  * @param valid false while the receiver starts, AirSim's for a second: then all else is zero, the time stamp
  *   too
  */
final case class GpsReading(location: GeoLocation, velocityNed: Vector3, valid: Boolean)

/** @param altitude altitude above sea level at which the standard atmosphere has this pressure */
final case class BarometerReading(altitude: Metres, pressurePa: Double)

/** One rotor's thrust, torque and speed, as AirSim reports them. */
final case class RotorReading(thrustN: Double, torqueNm: Double, speedRadPerS: Double)
