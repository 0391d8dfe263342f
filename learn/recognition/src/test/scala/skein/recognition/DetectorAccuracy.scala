package skein.recognition

import java.nio.ByteBuffer
import skein.units.*

/** A detector's results in images of a range.
  *
  * @param plain number of images with a quadrotor that should be detected
  * @param bearingsDeg errors of the detections, ascending
  * @param ranges measured divided by true range, ascending
  * @param inDeviations errors of the range divided by the measurement's own deviation, ascending
  */
final case class DetectorAccuracy(
    plain: Int,
    bearingsDeg: Vector[Double],
    ranges: Vector[Double],
    inDeviations: Vector[Double]
):
  def recall: Double = bearingsDeg.size.toDouble / plain

object DetectorAccuracy:
  val Camera: Pinhole = Pinhole(800, 600, Radians(StrictMath.toRadians(100)))

  /** A box whose middle is closer to a quadrotor's middle than this, or than half its size, counts as its
    * box; px.
    */
  private val NearPx = 8.0

  final case class Result(
      byRange: Vector[((Double, Double), DetectorAccuracy)],
      falselyFound: Int,
      images: Int
  ):
    def found: Int        = byRange.map(_._2.bearingsDeg.size).sum
    def recall: Double    = found.toDouble / byRange.map(_._2.plain).sum
    def precision: Double = found.toDouble / (found + falselyFound)

  /** @param ranges nearest and farthest range of each row, m
    * @param count number of images of each row
    */
  def measured(ranges: Seq[(Double, Double)], count: Int, seed: Long): Result =
    val detector = OnnxDetector(
      VehicleDetector.model.fold(sys.error, identity),
      InputForm(Camera.width / 2, Camera.height / 2)
    )
    val told    = VehicleDetector(Camera, detector, VehicleDetector.Appearance.Quadrotor)
    val images  = DroneImages(Camera, seed)
    var falsely = 0
    val rows    = ranges.toVector.map: range =>
      val seen = Vector.fill(count)(images.next(range)).map: image =>
        val boxes =
          detector.find(Camera.width, Camera.height, ByteBuffer.wrap(image.bgr)).fold(sys.error, identity)
        val (right, wrong) = boxes.partition(isOf(image, _))
        falsely += wrong.size + (right.size - 1).max(0)
        (image, right.headOption)
      val plain = seen.filter(_._1.isPlain)
      val polar =
        for
          case (image, Some(box)) <- plain
          at <- image.positionFrd
        yield (at, told.polar(box))
      range -> DetectorAccuracy(
        plain.size,
        polar.map((at, seen) => StrictMath.toDegrees(angle(at, seen))).sorted,
        polar.map((at, seen) => seen.range.value / at.norm).sorted,
        polar.map((at, seen) => (seen.range.value - at.norm) / seen.deviation.range.value).sorted
      )
    Result(rows, falsely, ranges.size * count)

  private def isOf(image: DroneImage, box: Box): Boolean = image.box.exists: whole =>
    val x = (box.left + box.right) / 2 - (whole.left + whole.right) / 2.0
    val y = (box.top + box.bottom) / 2 - (whole.top + whole.bottom) / 2.0
    math.abs(x) < NearPx.max((whole.right - whole.left) / 2.0) &&
    math.abs(y) < NearPx.max((whole.bottom - whole.top) / 2.0)

  private def angle(at: Vector3, seen: skein.fusion.PolarMeasurement): Double =
    import StrictMath.{cos, sin}
    val (az, el) = (seen.azimuth.value, seen.elevation.value)
    val looked   = Vector3(cos(el) * cos(az), cos(el) * sin(az), -sin(el))
    val true1    = at * (1 / at.norm)
    2 * StrictMath.asin((looked - true1).norm / 2)

/** Accuracy of the shipped detector by range, and its duration: `recognition/Test/runMain
  * skein.recognition.measureDetector COUNT SEED`. Seed 1 was used for its training.
  */
@main def measureDetector(count: Int, seed: Long): Unit =
  val ranges = Seq((1.5, 3.0), (3.0, 6.0), (6.0, 10.0), (10.0, 15.0), (15.0, 20.0), (20.0, 30.0))
  val result = DetectorAccuracy.measured(ranges, count, seed)
  def at(sorted: Vector[Double], q: Double) =
    if sorted.isEmpty then Double.NaN else sorted((q * (sorted.size - 1)).round.toInt)
  println(
    "range, m     plain  recall  bearing, °: median  95 %   measured / " +
      "true range: 16 %  median  84 %   deviations: 16 %  84 %"
  )
  for ((from, to), row) <- result.byRange do
    println(
      f"$from%4.1f to $to%4.1f ${row.plain}%6d ${row.recall}%7.3f ${at(row.bearingsDeg, 0.5)}%19.2f " +
        f"${at(row.bearingsDeg, 0.95)}%5.2f ${at(row.ranges, 0.16)}%28.3f ${at(row.ranges, 0.5)}%7.3f " +
        f"${at(row.ranges, 0.84)}%5.3f ${at(row.inDeviations, 0.16)}%18.2f ${at(row.inDeviations, 0.84)}%5.2f"
    )
  println(
    f"of ${result.images} images: recall ${result.recall}%.3f, precision " +
      f"${result.precision}%.3f, ${result.falselyFound} boxes where nothing is"
  )
  val camera   = DetectorAccuracy.Camera
  val detector = VehicleDetector.shipped(camera).fold(sys.error, identity)
  val images   = DroneImages(camera, seed)
  val some     = Vector.fill(32)(ByteBuffer.wrap(images.next().bgr))
  val times    =
    for _ <- 1 to 12; image <- some yield
      val began = System.nanoTime()
      detector.find(camera.width, camera.height, image).fold(sys.error, identity): Unit
      (System.nanoTime() - began) * 1e-6
  val warm = times.drop(64).toVector.sorted
  println(
    f"time of one ${camera.width} × ${camera.height} image, one thread: " +
      f"median ${at(warm, 0.5)}%.1f ms, 99 %% ${at(warm, 0.99)}%.1f ms"
  )
