package skein.fusion

import skein.signal.{LatencyDistribution, NormalQuantile}
import skein.units.*

/** A model of a vehicle that sees its opponent only through a camera. It determines whether an image shows
  * the opponent and whether it is detected, the measured position, and the time at which that is known. The
  * model consists of formulas of both positions, which `skein.identify` fits to flights. Images are taken,
  * sent and recognised as in `skein.flow.Frames` and `Recognise`; detections enter a [[Fusion]]. The camera
  * points at the opponent's position as estimated at the last decision, as in `skein.policy.CameraPursuer`;
  * turning and tilting take no time in this model.
  *
  * @param everyS time between images
  * @param fovRad horizontal field of view
  * @param farthestM range of detection
  * @param detection probability that an opponent in view is detected
  * @param bearingSdRad standard deviation of the bearing
  * @param rangeBias mean of the measured range divided by the true range
  * @param rangeSd standard deviation of the measured range, as a fraction of the range
  * @param takes duration of recognition
  * @param workers number of images recognised simultaneously
  * @param deadlineS deadline for each image's result; a later result is discarded
  */
final case class SensorModel(
    everyS: Double,
    fovRad: Double,
    farthestM: Double,
    detection: Double,
    bearingSdRad: Double,
    rangeBias: Double,
    rangeSd: Double,
    takes: LatencyDistribution,
    workers: Int = 2,
    deadlineS: Double = 0.3,
    fusion: FusionSettings = FusionSettings()
):
  require(everyS >= 0.001, s"expected a millisecond or more between images, got $everyS s")
  require(takes.quantile(0) >= Span.Zero, s"expected a recognition that takes no negative time, got $takes")
  require(fovRad > 0 && fovRad < math.Pi, s"expected a field of view between 0 and π, got $fovRad rad")
  require(farthestM > 0, s"expected a positive largest range, got $farthestM m")
  require(detection >= 0 && detection <= 1, s"expected a detection between 0 and 1, got $detection")
  require(bearingSdRad > 0, s"expected a positive standard deviation of the bearing, got $bearingSdRad rad")
  require(rangeBias > 0, s"expected a positive bias of the range, of 1 where it is exact, got $rangeBias")
  require(rangeSd > 0, s"expected a positive standard deviation of the range, got $rangeSd")
  require(workers > 0, s"expected at least one worker, got $workers")
  require(deadlineS > 0, s"expected a positive deadline, got $deadlineS s")

  /** The measurement from an image, if the opponent is detected in it. */
  def measured(at: Instant, image: Exposure): Option[Measurement] =
    import image.{axisRad, opponentNed, ownNed}
    Option.when(image.found < detection && isInView(axisRad, ownNed, opponentNed)):
      val (bearing, range)    = (SensorModel.normal(image.bearing), SensorModel.normal(image.range))
      val (place, covariance) = seen(axisRad, ownNed, opponentNed, bearing, range)
      Measurement(at, place, covariance)

  /** Whether the opponent is in an image's field of view and range. */
  private[fusion] def isInView(axisRad: Double, ownNed: Vector3, opponentNed: Vector3): Boolean =
    val way      = opponentNed - ownNed
    val distance = way.norm
    math.abs(offAxis(axisRad, way)) < fovRad / 2 && distance <= farthestM && distance > 0

  /** The measured position of an opponent in view, NED, with its covariance, m².
    *
    * @param bearing sample of the standard normal distribution, like `range`
    */
  private[fusion] def seen(
      axisRad: Double,
      ownNed: Vector3,
      opponentNed: Vector3,
      bearing: Double,
      range: Double
  ): (positionNed: Vector3, covariance: Matrix3) =
    val way      = opponentNed - ownNed
    val distance = way.norm
    val measured = distance * math.max(0.1, rangeBias + rangeBias * rangeSd * range)
    PolarMeasurement(
      Radians(offAxis(axisRad, way) + bearingSdRad * bearing),
      Radians(StrictMath.asin(-way.z / distance)),
      Metres(measured),
      (
        azimuth = Radians(bearingSdRad),
        elevation = Radians(bearingSdRad),
        range = Metres(measured * rangeSd)
      )
    ).placedFrom(ownNed, Quaternion(StrictMath.cos(axisRad / 2), 0, 0, StrictMath.sin(axisRad / 2)))

  private def offAxis(axisRad: Double, way: Vector3) =
    math.IEEEremainder(StrictMath.atan2(way.y, way.x) - axisRad, 2 * math.Pi)

/** An exposed image with its random samples.
  *
  * @param axisRad direction of the camera, from north to the east
  * @param ownNed the vehicle's own position, m; `opponentNed` likewise
  * @param found sample that is uniform in [0, 1], like `bearing` and `range`
  */
final case class Exposure(
    axisRad: Double,
    ownNed: Vector3,
    opponentNed: Vector3,
    found: Double,
    bearing: Double,
    range: Double
)

object SensorModel:
  /** Converts a sample that is uniform in [0, 1] to a sample of the standard normal distribution. */
  private[skein] def normal(even: Double): Double = NormalQuantile(even.max(1e-9).min(1 - 1e-9))
