package skein.ros

import java.nio.{ByteBuffer, ByteOrder}
import scala.collection.immutable.ArraySeq
import skein.ros.message.*
import skein.units.{Instant, Radians, Quaternion as Rotation, Vector3 as Ned}

/** Images and scans, with their frames, as messages of `sensor_msgs` and `geometry_msgs`. */
object SensorMessages:
  /** A part of a topic's or a frame's name: what is no letter, digit or `_` becomes `_`. */
  def token(name: String): String =
    val plain = name.map(letter => if letter < 128 && letter.isLetterOrDigit then letter else '_')
    if plain.headOption.forall(_.isDigit) then s"_$plain" else plain

  /** Where a camera's optical frame is in the world (x right, y down, z forward; REP 103).
    *
    * @param orientation from the camera's front, right, down to world NED
    */
  def optical(at: Instant, frame: String, positionNed: Ned, orientation: Rotation): TransformStamped =
    VehicleMessages.transform(at, frame, positionNed, RosFrames.toEnu(orientation) * FluFromOptical)

  /** @param pixels rows from the top, without gaps
    * @param encoding by its name in ROS, such as `bgr8`
    */
  def image(header: Header, width: Int, height: Int, encoding: String, pixels: Array[Byte]): Image =
    val step = if height > 0 then pixels.length / height else 0
    Image(header, height, width, encoding, 0, step, ArraySeq.unsafeWrapArray(pixels))

  /** A pinhole camera without distortion; the middles of pixels are at whole numbers, as in OpenCV. */
  def cameraInfo(header: Header, width: Int, height: Int, fov: Radians): CameraInfo =
    val focal  = width / 2.0 / StrictMath.tan(fov.value / 2)
    val (x, y) = ((width - 1) / 2.0, (height - 1) / 2.0)
    CameraInfo(
      header,
      height,
      width,
      "plumb_bob",
      ArraySeq(0.0, 0.0, 0.0, 0.0, 0.0),
      Doubles.of(Seq(focal, 0, x, 0, focal, y, 0, 0, 1)),
      Doubles.of(Seq(1, 0, 0, 0, 1, 0, 0, 0, 1)),
      Doubles.of(Seq(focal, 0, x, 0, 0, focal, y, 0, 0, 0, 1, 0)),
      0,
      0,
      RegionOfInterest(0, 0, 0, 0, false)
    )

  /** A cloud of `count` points; `point` is each one's place in the header's frame, m. */
  def points(header: Header, count: Int)(point: Int => Ned): PointCloud2 =
    val bytes = ByteBuffer.allocate(count * PointBytes).order(ByteOrder.LITTLE_ENDIAN)
    for number <- 0 until count do
      val at = point(number)
      bytes.putFloat(at.x.toFloat).putFloat(at.y.toFloat).putFloat(at.z.toFloat): Unit
    PointCloud2(
      header,
      1,
      count,
      Vector("x", "y", "z").zipWithIndex.map((name, at) => PointField(name, 4 * at, Float32, 1)),
      isBigendian = false,
      PointBytes,
      PointBytes * count,
      ArraySeq.unsafeWrapArray(bytes.array),
      isDense = true
    )

  /** From a camera's optical frame to its front, left, up. */
  private val FluFromOptical = Rotation(0.5, -0.5, 0.5, -0.5)

  private val PointBytes    = 12
  private val Float32: Byte = 7
