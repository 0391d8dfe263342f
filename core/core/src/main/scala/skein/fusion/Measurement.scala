package skein.fusion

import skein.units.*

/** A measured position of a vehicle: its own reading, or a detection by another vehicle's camera or LIDAR.
  *
  * @param validAt time at which physics was sampled or the image exposed; on one clock for all measurements
  *   of a vehicle
  * @param positionNed the measured position, m
  * @param covariance the position's covariance, NED, m²
  * @param velocity velocity with its covariance, if it was measured: NED, m/s, m²/s²
  */
final case class Measurement(
    validAt: Instant,
    positionNed: Vector3,
    covariance: Matrix3,
    velocity: Option[(ned: Vector3, covariance: Matrix3)] = None
):
  require(
    covariance.determinant > 0 && velocity.forall(_.covariance.determinant > 0),
    s"a measurement's covariance is positive: $this"
  )

/** A camera's or lidar's measurement of a detected object, in the sensor's frame (front, right, down).
  *
  * @param azimuth angle to the right of straight ahead
  * @param elevation angle above straight ahead
  * @param range distance along the line of sight
  * @param deviation standard deviations of the three, which are independent
  */
final case class PolarMeasurement(
    azimuth: Radians,
    elevation: Radians,
    range: Metres,
    deviation: (azimuth: Radians, elevation: Radians, range: Metres)
):

  /** The object's position, from the sensor's pose at the exposure. Linearised about the measured values
    * ("converted measurement"), which is accurate if range · angle² is small compared with the range's
    * standard deviation: Lerro and Bar-Shalom, IEEE Transactions on Aerospace and Electronic Systems 29
    * (1993), 1015.
    *
    * @param positionNed the sensor's position, m
    * @param orientation rotates from the sensor's frame to world NED
    */
  def seenFrom(validAt: Instant, positionNed: Vector3, orientation: Quaternion): Measurement =
    val (place, covariance) = placedFrom(positionNed, orientation)
    Measurement(validAt, place, covariance)

  /** The object's position, NED, m, with its covariance, m². */
  private[fusion] def placedFrom(
      positionNed: Vector3,
      orientation: Quaternion
  ): (positionNed: Vector3, covariance: Matrix3) =
    import StrictMath.{cos, sin}
    val (az, el, r)                             = (azimuth.value, elevation.value, range.value)
    def turned(x: Double, y: Double, z: Double) = PolarMeasurement.turned(Vector3(x, y, z), orientation)
    val ahead                                   = turned(cos(el) * cos(az), cos(el) * sin(az), -sin(el))
    val right                                   = turned(-cos(el) * sin(az), cos(el) * cos(az), 0) * r
    val upwards                                 = turned(-sin(el) * cos(az), -sin(el) * sin(az), -cos(el)) * r
    (
      positionNed + ahead * r,
      Matrix3.along(ahead * deviation.range.value) +
        Matrix3.along(right * deviation.azimuth.value) +
        Matrix3.along(upwards * deviation.elevation.value)
    )

object PolarMeasurement:

  /** The measurement of a point in the sensor's frame (front, right, down), m. */
  def of(
      pointFrd: Vector3,
      deviation: (azimuth: Radians, elevation: Radians, range: Metres)
  ): PolarMeasurement =
    val flat = StrictMath.hypot(pointFrd.x, pointFrd.y)
    PolarMeasurement(
      Radians(StrictMath.atan2(pointFrd.y, pointFrd.x)),
      Radians(StrictMath.atan2(-pointFrd.z, flat)),
      Metres(pointFrd.norm),
      deviation
    )

  private def turned(v: Vector3, q: Quaternion): Vector3 =
    val (ux, uy, uz) = (
      q.y * v.z - q.z * v.y + q.w * v.x,
      q.z * v.x - q.x * v.z + q.w * v.y,
      q.x * v.y - q.y * v.x + q.w * v.z
    )
    v + Vector3(q.y * uz - q.z * uy, q.z * ux - q.x * uz, q.x * uy - q.y * ux) * 2
