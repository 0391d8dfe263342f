package skein.airsim.wire

import skein.units.Instant
import upickle.default.ReadWriter

/** Gravity in m/s² (NED), pressure in Pa, temperature in K, density in kg/m³. */
final private[airsim] case class EnvironmentState(
    position: Vector3r,
    geo_point: GeoPoint,
    gravity: Vector3r,
    air_pressure: Float,
    temperature: Float,
    air_density: Float
) derives ReadWriter

final private[airsim] case class RotorStates(timestamp: Instant, rotors: Seq[RotorState]) derives ReadWriter

/** Thrust in N, torque in N·m (AirSim calls it `torque_scaler`), speed in rad/s. */
final private[airsim] case class RotorState(thrust: Float, torque_scaler: Float, speed: Float)
    derives ReadWriter
