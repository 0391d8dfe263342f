package skein.identify

import skein.fusion.SensorModel
import skein.signal.{LatencyDistribution, NormalQuantile}

/** One detection and the true values.
  *
  * @param bearingErrorRad measured less true azimuth
  * @param rangeM measured range
  * @param trueRangeM range from the camera's true position
  * @param tookMs duration of recognition
  */
final case class Detected(bearingErrorRad: Double, rangeM: Double, trueRangeM: Double, tookMs: Double)

/** The detections of one camera and its recogniser in a flight.
  *
  * @param everyS requested time between images
  * @param fovRad horizontal field of view
  * @param images number of images that were searched, up to the last detection
  * @param readings number of the vehicle's own readings in that time
  * @param inViewM range of the target at each of them at which it was in the camera's view, according to both
  *   true positions, m
  */
final case class Seeing(
    everyS: Double,
    fovRad: Double,
    workers: Int,
    deadlineS: Double,
    images: Int,
    readings: Int,
    inViewM: Vector[Double],
    detections: Vector[Detected]
)

/** A [[skein.fusion.SensorModel]] fitted to a recogniser's detections: the mean and deviation of its errors,
  * the frequency of detection in view, and the measured durations of recognition. Deviations and the
  * frequency have 95 % confidence intervals that assume independent detections. Persistent errors are not
  * covered, such as a range that is wrong as long as one side of the target is visible.
  */
final case class SensorFit(model: SensorModel, images: Int, detections: Int, fitted: Vector[Fitted])

object SensorFit:
  /** Smallest number of detections from which deviations can be estimated. */
  val LeastDetections = 30

  /** Fits the model. Left says what the flights lack. */
  def of(seeing: Vector[Seeing]): Either[String, SensorFit] =
    val all = seeing.flatMap(_.detections)
    if all.sizeIs < LeastDetections then
      Left(s"expected at least $LeastDetections detections to identify a sensor, got ${all.size}")
    else if seeing.map(one => (one.everyS, one.fovRad, one.workers, one.deadlineS)).distinct.sizeIs > 1 then
      Left("expected flights with one kind of eye, got several")
    else Right(fit(seeing, all))

  private def fit(seeing: Vector[Seeing], all: Vector[Detected]): SensorFit =
    val n       = all.size
    val bearing = math.sqrt(all.map(one => one.bearingErrorRad * one.bearingErrorRad).sum / n)
    val ratios  = all.map(one => one.rangeM / one.trueRangeM)
    val bias    = ratios.sum / n
    val rangeSd = math.sqrt(ratios.map(ratio => (ratio - bias) * (ratio - bias)).sum / (n - 1)) / bias
    // The model detects nothing beyond the farthest detection.
    val farthest = all.map(_.trueRangeM).max
    val inView   = seeing.map: one =>
      one.images * one.inViewM.count(_ <= farthest).toDouble / one.readings.max(1)
    .sum
    val detected = if inView > 0 then (n / inView).min(1) else 1.0
    val one      = seeing.head
    val model    = SensorModel(
      one.everyS,
      one.fovRad,
      farthest,
      detected,
      bearing,
      bias,
      rangeSd,
      LatencyDistribution.ofSamples(takes(all.map(_.tookMs).sorted)),
      one.workers,
      one.deadlineS
    )
    val spread        = NormalQuantile.TwoSided95 / math.sqrt(2.0 * n)
    val (least, most) = wilson(detected, inView)
    val ofBias        = NormalQuantile.TwoSided95 * rangeSd * bias / math.sqrt(n.toDouble)
    SensorFit(
      model,
      seeing.map(_.images).sum,
      n,
      Vector(
        Fitted("detection", detected, least, most, atBound = detected == 1),
        Fitted(
          "bearing-sd-deg",
          deg(bearing),
          deg(bearing * (1 - spread)),
          deg(bearing * (1 + spread)),
          false
        ),
        Fitted("range-bias", bias, bias - ofBias, bias + ofBias, false),
        Fitted("range-sd", rangeSd, rangeSd * (1 - spread), rangeSd * (1 + spread), false)
      )
    )

  /** Reduces the durations of recognition to a limited number of quantiles. */
  private def takes(sorted: Vector[Double]): Vector[Double] =
    if sorted.sizeIs <= Quantiles then sorted
    else
      Vector.tabulate(Quantiles)(i => sorted((i.toDouble / (Quantiles - 1) * (sorted.size - 1)).round.toInt))

  private val Quantiles = 41

  private def deg(rad: Double) = StrictMath.toDegrees(rad)

  private def wilson(share: Double, n: Double): (Double, Double) =
    val z2     = NormalQuantile.TwoSided95 * NormalQuantile.TwoSided95
    val middle = (share + z2 / (2 * n)) / (1 + z2 / n)
    val half   =
      NormalQuantile.TwoSided95 / (1 + z2 / n) * math.sqrt(share * (1 - share) / n + z2 / (4 * n * n))
    (middle - half, middle + half)
