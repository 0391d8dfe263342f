package skein.fusion

import skein.signal.{LatencyDistribution, NormalQuantile}
import skein.units.*

/** What a vehicle knows if it sees its opponent by a camera alone: whether an image shows the opponent and it
  * is detected, the measured position, and when it is known. Written as formulas of both positions, which
  * `skein.identify` fits to flights. Images are taken, sent and recognised as in `skein.flow.Frames` and
  * `Recognise`; detections enter a [[Fusion]]. The camera points at the opponent's estimated position at the
  * last decision, as `skein.policy.CameraPursuer` turns it; turning and tilting take no time in this model.
  *
  * @param everyS time between images
  * @param fovRad horizontal
  * @param farthestM nothing beyond it is found
  * @param detection probability that an opponent in view is found
  * @param bearingSdRad standard deviation of the bearing
  * @param rangeBias mean of the measured over the true range
  * @param rangeSd standard deviation of the measured range, as a share of it
  * @param takes duration of recognition
  * @param workers number of images recognised simultaneously
  * @param deadlineS of each image; a later result is discarded
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
  require(everyS >= 0.001, s"expected a millisecond or more between images, came $everyS s")
  require(takes.quantile(0) >= Span.Zero, s"expected a recognition that takes no negative time, came $takes")
  require(fovRad > 0 && fovRad < math.Pi, s"expected a field of view between 0 and π, came $fovRad rad")
  require(farthestM > 0, s"expected a positive largest range, came $farthestM m")
  require(detection >= 0 && detection <= 1, s"expected a detection between 0 and 1, came $detection")
  require(bearingSdRad > 0, s"expected a positive standard deviation of the bearing, came $bearingSdRad rad")
  require(rangeBias > 0, s"expected a positive bias of the range, of 1 where it is exact, came $rangeBias")
  require(rangeSd > 0, s"expected a positive standard deviation of the range, came $rangeSd")
  require(workers > 0, s"expected at least one worker, came $workers")
  require(deadlineS > 0, s"expected a positive deadline, came $deadlineS s")

  /** The measurement from an image, if the opponent is found in it. */
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
    * @param bearing and `range`: two samples of the standard normal distribution
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
  * @param ownNed own and opponent's position, m
  * @param found and `bearing`, `range`: three samples, uniform in 0 to 1
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
  /** A sample of the standard normal distribution, from one that is uniform in 0 to 1. */
  private[skein] def normal(even: Double): Double = NormalQuantile(even.max(1e-9).min(1 - 1e-9))
