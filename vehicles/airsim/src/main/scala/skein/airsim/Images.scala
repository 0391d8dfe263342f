package skein.airsim

import skein.rpc.{Bytes, MessageReader}
import skein.units.*

/** The kinds of images, with AirSim's numbers. Cosys-AirSim has further kinds. */
enum ImageKind:
  case Scene, DepthPlanar, DepthPerspective, DepthVis, DisparityNormalized, Segmentation, SurfaceNormals,
    Infrared, OpticalFlow, OpticalFlowVis

  def number: Int = ordinal

/** The encodings of an image's pixels on the wire. */
enum Encoding:
  case Raw

  /** A PNG file. Encoding takes the simulator long. */
  case Png

  /** One 32-bit float per pixel; depths are in m. */
  case Numbers

/** A request for one image.
  *
  * @param camera the camera's name; `0` is the front one
  */
final case class Shot(camera: String, kind: ImageKind = ImageKind.Scene, encoding: Encoding = Encoding.Raw)

/** The pixels of an image, in rows from the top, without gaps. */
enum Pixels:
  case Bgr(bytes: Bytes)

  case Png(file: Bytes)

  case Numbers(values: Array[Float])

/** One image.
  *
  * @param positionNed the camera's position at exposure, world, m
  * @param orientation rotation from the camera's frame (front, right, down) to world NED
  */
final case class Image(
    shot: Shot,
    width: Int,
    height: Int,
    pixels: Pixels,
    positionNed: Vector3,
    orientation: Quaternion
)

/** A lidar's scan.
  *
  * @param points x, y, z of each, m, in the frame that the lidar's settings choose: the lidar's own, or that
  *   of its vehicle's start
  * @param segmentation id of the object that each point is on; empty if the simulator does not send it
  * @param positionNed the lidar's position, world, m
  */
final case class Scan(
    points: Array[Float],
    segmentation: Array[Int],
    positionNed: Vector3,
    orientation: Quaternion
):
  def size: Int = points.length / 3

  /** Distance in the horizontal plane to the nearest point in each of `sectors` equal sectors, clockwise from
    * north, m; for points in the lidar's own frame.
    *
    * @param bandM points more than this above or below do not count
    * @param farM the value of a sector without points
    */
  def nearest(sectors: Int, bandM: Double, farM: Double): Array[Double] =
    import orientation.{w, x, y, z}
    val found = Array.fill(sectors)(farM)
    var at    = 0
    while at < points.length do
      val (front, right, down) = (points(at).toDouble, points(at + 1).toDouble, points(at + 2).toDouble)
      val below                =
        2 * (x * z - w * y) * front + 2 * (y * z + w * x) * right + (1 - 2 * (x * x + y * y)) * down
      if math.abs(below) <= bandM then
        val north =
          (1 - 2 * (y * y + z * z)) * front + 2 * (x * y - w * z) * right + 2 * (x * z + w * y) * down
        val east =
          2 * (x * y + w * z) * front + (1 - 2 * (x * x + z * z)) * right + 2 * (y * z - w * x) * down
        val turns  = StrictMath.atan2(east, north) / (2 * math.Pi)
        val sector = (((turns + 1) % 1) * sectors).toInt.min(sectors - 1)
        found(sector) = found(sector).min(math.sqrt(north * north + east * east))
      at += 3
    found

/** Reads images and scans as AirSim, Colosseum and Cosys-AirSim send them: keys in any order, unknown keys
  * skipped, missing keys as empty. An answer that cannot be read ends with [[MessageReader]]'s error.
  */
private[airsim] object Images:

  /** Reads the answer to `simGetImages` and the time of exposure; None for an image that the simulator could
    * not take, with its message.
    */
  def read(
      in: MessageReader,
      shots: Seq[Shot],
      originNed: Vector3
  ): Either[String, (Vector[Image], Instant)] =
    val came = Vector.fill(in.array())(readOne(in))
    if came.size != shots.size then Left(s"expected ${shots.size} images, got ${came.size}")
    else
      Expect
        .each(came.zip(shots))((one, shot) => one.image(shot, originNed))
        .map((_, came.headOption.fold(Instant.Epoch)(_.at)))

  private final class Came:
    var bytes         = Bytes.empty
    var numbers       = Array.emptyFloatArray
    var position      = Vector3.Zero
    var orientation   = Quaternion.Identity
    var at            = Instant.Epoch
    var message       = ""
    var width, height = 0

    def image(shot: Shot, originNed: Vector3): Either[String, Image] =
      val size             = width.toLong * height
      def isSized(of: Int) = width > 0 && height > 0 && of.toLong == size
      val pixels           = shot.encoding match
        case Encoding.Raw if isSized(bytes.length / 3) && bytes.length % 3 == 0 => Right(Pixels.Bgr(bytes))
        case Encoding.Png if bytes.length > 1            => Right(Pixels.Png(bytes))
        case Encoding.Numbers if isSized(numbers.length) => Right(Pixels.Numbers(numbers))
        case encoding                                    =>
          val said = if message.isEmpty then "" else s"; the simulator says: ${message.take(200)}"
          Left(
            s"expected ${shot.kind} of camera '${shot.camera}' as $encoding, got $width × " +
              s"$height pixels in ${bytes.length} bytes and ${numbers.length} numbers$said"
          )
      pixels.map(Image(shot, width, height, _, position + originNed, orientation))

  private def readOne(in: MessageReader): Came =
    val came = Came()
    in.fields:
      case "image_data_uint8"   => came.bytes = in.binary()
      case "image_data_float"   => came.numbers = in.floats()
      case "camera_position"    => came.position = vector(in)
      case "camera_orientation" => came.orientation = quaternion(in)
      case "time_stamp"         => came.at = Instant.ofNanos(in.long())
      case "message"            => came.message = in.string()
      case "width"              => came.width = in.int()
      case "height"             => came.height = in.int()
    came

  /** Reads the answer to `getLidarData` and the time of the scan. A cloud of one number is AirSim's encoding
    * of an empty one.
    */
  def readScan(in: MessageReader, originNed: Vector3): Either[String, (Scan, Instant)] =
    var points       = Array.emptyFloatArray
    var segmentation = Array.emptyIntArray
    var at           = Instant.Epoch
    var position     = Vector3.Zero
    var orientation  = Quaternion.Identity
    in.fields:
      case "point_cloud"  => points = in.floats()
      case "segmentation" => segmentation = in.ints()
      case "time_stamp"   => at = Instant.ofNanos(in.long())
      case "pose"         =>
        in.fields:
          case "position"    => position = vector(in)
          case "orientation" => orientation = quaternion(in)
    if points.length == 1 then
      points = Array.emptyFloatArray
      segmentation = Array.emptyIntArray
    if points.length % 3 != 0 then Left(s"expected x, y, z of each point, got ${points.length} numbers")
    else if segmentation.length > 0 && segmentation.length != points.length / 3 then
      Left(s"expected ${points.length / 3} segmentation ids, got ${segmentation.length}")
    else Right((Scan(points, segmentation, position + originNed, orientation), at))

  /** Reads the field of view from the answer to `simGetCameraInfo`. */
  def readFov(in: MessageReader): Radians =
    var degrees = 0.0
    in.fields:
      case "fov" => degrees = in.double()
    Radians(StrictMath.toRadians(degrees))

  private def vector(in: MessageReader): Vector3 =
    var (x, y, z) = (0.0, 0.0, 0.0)
    in.fields:
      case "x_val" => x = in.double()
      case "y_val" => y = in.double()
      case "z_val" => z = in.double()
    Vector3(x, y, z)

  private def quaternion(in: MessageReader): Quaternion =
    var (w, x, y, z) = (1.0, 0.0, 0.0, 0.0)
    in.fields:
      case "w_val" => w = in.double()
      case "x_val" => x = in.double()
      case "y_val" => y = in.double()
      case "z_val" => z = in.double()
    Quaternion(w, x, y, z)
