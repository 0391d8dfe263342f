package skein.airsim.wire

import skein.units.Instant

/** Angular velocity (rad/s) and specific force (m/s²) in body FRD. */
final private[skein] case class ImuData(
    time_stamp: Instant,
    orientation: Quaternionr,
    angular_velocity: Vector3r,
    linear_acceleration: Vector3r
) derives Fields

/** Altitude in m, pressure in Pa, `qnh` in hPa. */
final private[skein] case class BarometerData(
    time_stamp: Instant,
    altitude: Float,
    pressure: Float,
    qnh: Float
) derives Fields

/** Gauss, body FRD; the covariance is always empty. */
final private[skein] case class MagnetometerData(
    time_stamp: Instant,
    magnetic_field_body: Vector3r,
    magnetic_field_covariance: Seq[Float]
) derives Fields

final private[skein] case class GpsData(time_stamp: Instant, gnss: GnssReport, is_valid: Boolean)
    derives Fields

/** `eph` and `epv` are the dilutions of precision, `velocity` NED in m/s, `fix_type` 3 a three-dimensional
  * fix, `time_utc` microseconds.
  */
final private[skein] case class GnssReport(
    geo_point: GeoPoint,
    eph: Float,
    epv: Float,
    velocity: Vector3r,
    fix_type: Int,
    time_utc: Instant
) derives Fields
