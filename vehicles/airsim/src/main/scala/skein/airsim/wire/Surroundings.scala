package skein.airsim.wire

import skein.units.Instant

/** Gravity in m/s² (NED), pressure in Pa, temperature in K, density in kg/m³. */
final private[skein] case class EnvironmentState(
    position: Vector3r,
    geo_point: GeoPoint,
    gravity: Vector3r,
    air_pressure: Float,
    temperature: Float,
    air_density: Float
) derives Fields

final private[skein] case class RotorStates(rotors: Seq[RotorState], timestamp: Instant) derives Fields

/** Thrust in N and torque in N·m (AirSim calls it `torque_scaler`), both as at sea level; the torque is
  * negative for rotors that turn counter-clockwise. Speed in rad/s, never negative.
  */
final private[skein] case class RotorState(thrust: Float, torque_scaler: Float, speed: Float)
    derives Fields
