package skein.ros

import java.nio.{ByteBuffer, ByteOrder}
import scala.collection.immutable.ArraySeq
import skein.airsim.{Image as SeenImage, Pixels, Scan}
import skein.ros.message.*
import skein.units.{Instant, Radians, Quaternion as Rotation, Vector3 as Ned}

/** Images and scans, with their frames, as messages of `sensor_msgs` and `geometry_msgs`. */
object SensorMessages:
  /** A part of a topic's or a frame's name: every character except letters, digits and `_` becomes `_`. */
  def token(name: String): String =
    val plain = name.map(letter => if letter < 128 && letter.isLetterOrDigit then letter else '_')
    if plain.headOption.forall(_.isDigit) then s"_$plain" else plain

  /** Where a camera's optical frame is in the world (x right, y down, z forward; REP 103).
    *
    * @param orientation rotation from the camera's front, right, down to world NED
    */
  def optical(at: Instant, frame: String, positionNed: Ned, orientation: Rotation): TransformStamped =
    VehicleMessages.transform(at, frame, positionNed, RosFrames.toEnu(orientation) * FluFromOptical)

  /** Colours as `bgr8`, and depths as `32FC1`, m, with +∞ where nothing is (REP 118). None for a file. */
  def image(header: Header, seen: SeenImage): Option[Image] =
    val pixels = seen.pixels match
      case Pixels.Bgr(bytes)      => Some(("bgr8", bytes.toArray))
      case Pixels.Numbers(depths) => Some(("32FC1", floats(depths)))
      case Pixels.Png(_)          => None
    pixels.map(image(header, seen.width, seen.height, _, _))

  /** @param pixels rows from the top, without gaps
    * @param encoding its name in ROS, such as `bgr8`
    */
  def image(header: Header, width: Int, height: Int, encoding: String, pixels: Array[Byte]): Image =
    val step = if height > 0 then pixels.length / height else 0
    Image(header, height, width, encoding, 0, step, ArraySeq.unsafeWrapArray(pixels))

  private def floats(depths: Array[Float]): Array[Byte] =
    val bytes = ByteBuffer.allocate(4 * depths.length).order(ByteOrder.LITTLE_ENDIAN)
    for depth <- depths do bytes.putFloat(if depth < BeyondM then depth else Float.PositiveInfinity): Unit
    bytes.array

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

  /** A cloud of `count` points; `point` is each one's position in the header's frame, m. */
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

  /** A scan as a cloud, in the world's frame or in the lidar's own, and where that is in the world.
    *
    * @param frame name of the lidar's frame
    * @param isLocal whether its points are in the lidar's frame, else in the vehicle's world frame
    * @param startNed origin of that frame
    */
  def scan(
      scan: Scan,
      at: Instant,
      frame: String,
      isLocal: Boolean,
      startNed: Ned
  ): (Option[TransformStamped], PointCloud2) =
    def point(number: Int) =
      Ned(scan.points(3 * number), scan.points(3 * number + 1), scan.points(3 * number + 2))
    val placed = Option.when(isLocal):
      VehicleMessages.transform(at, frame, scan.positionNed, RosFrames.toEnu(scan.orientation))
    val header = Header(Time.of(at), if isLocal then frame else VehicleMessages.World)
    val cloud  = points(header, scan.size): number =>
      if isLocal then RosFrames.swapBody(point(number)) else RosFrames.swapWorld(point(number) + startNed)
    (placed, cloud)

  /** AirSim's depth of the sky, m: the greatest half-precision float. */
  private val BeyondM = 65504f

  /** From a camera's optical frame to its front, left, up. */
  private val FluFromOptical = Rotation(0.5, -0.5, 0.5, -0.5)

  private val PointBytes    = 12
  private val Float32: Byte = 7
