package skein.record

import java.nio.ByteBuffer
import java.nio.ByteOrder.LITTLE_ENDIAN
import skein.units.*

/** A camera or a lidar whose images or clouds are shown.
  *
  * @param name the lidar's or the camera's name; for image kinds other than `Scene`, a slash and the kind
  *   follow
  */
final case class ImagingSensor(vehicle: String, name: String, isLidar: Boolean)

object ImagingSensor:
  def of(record: Record): Option[ImagingSensor] = record match
    case image: CameraImage => Some(camera(image.vehicle, image.camera, image.kind))
    case cloud: Cloud       => Some(ImagingSensor(cloud.vehicle, cloud.lidar, isLidar = true))
    case _                  => None

  def camera(vehicle: String, camera: String, kind: String): ImagingSensor =
    ImagingSensor(vehicle, if kind == "Scene" then camera else s"$camera/$kind", isLidar = false)

/** Encodes images and clouds for viewers, as messages of Protocol Buffers, by Foxglove's schemas. */
trait ImageEncoding:
  /** The schema of images, a name in [[FoxgloveSchemas.binary]]. */
  def imageSchema: String

  /** @param at time of exposure, on the controller's clock
    * @param frame name of the camera's frame: right, down, front
    */
  def image(image: CameraImage, at: Instant, frame: String): Array[Byte]

  def mostPoints: Int

object ImageEncoding:

  /** Encodes images and clouds without loss. */
  object Whole extends ImageEncoding:
    val imageSchema = "foxglove.RawImage"
    val mostPoints  = Int.MaxValue

    def image(image: CameraImage, at: Instant, frame: String): Array[Byte] =
      val bytesAPixel = if image.encoding == "bgr8" then 3 else 4
      Protobuf(image.pixels.size + 128)
        .message(1, timestamp(at))
        .fixed32(2, image.width.toInt)
        .fixed32(3, image.height.toInt)
        .text(4, image.encoding)
        .fixed32(5, image.width.toInt * bytesAPixel)
        .bytes(RawImageData, image.pixels.bytes)
        .text(7, frame)
        .result

  private[record] val RawImageData   = 6
  private[record] val PointCloudData = 6

  /** `foxglove.CompressedImage`.
    *
    * @param format encoding of the file, for example `jpeg`
    */
  def compressed(file: Array[Byte], format: String, at: Instant, frame: String): Array[Byte] =
    Protobuf(file.length + 128)
      .message(1, timestamp(at))
      .bytes(2, file)
      .text(3, format)
      .text(4, frame)
      .result

  /** Encodes a `foxglove.PointCloud`; only every n-th point if there are too many. */
  private[record] def cloud(cloud: Cloud, at: Instant, mostPoints: Int): Array[Byte] =
    val data   = thinned(cloud.xyz.bytes, mostPoints)
    val fields = Seq("x" -> 0, "y" -> 4, "z" -> 8).map((name, offset) =>
      Protobuf().text(1, name).fixed32(2, offset).varint(3, Float32)
    )
    val (p, q) = (cloud.positionNed, cloud.orientation)
    val pose   = Protobuf()
      .message(1, Protobuf().double(1, p.x).double(2, p.y).double(3, p.z))
      .message(2, Protobuf().double(1, q.x).double(2, q.y).double(3, q.z).double(4, q.w))
    val message = Protobuf(data.length + 256)
      .message(1, timestamp(at))
      .text(2, "world_ned")
      .message(3, pose)
      .fixed32(4, PointBytes)
    fields.foreach(message.message(5, _))
    message.bytes(PointCloudData, data).result

  private val Float32    = 7
  private val PointBytes = 12

  private def thinned(xyz: Array[Byte], most: Int): Array[Byte] =
    val points = xyz.length / PointBytes
    if points <= most then xyz
    else
      val every = (points + most - 1) / most
      val out   = ByteBuffer.allocate((points + every - 1) / every * PointBytes).order(LITTLE_ENDIAN)
      for point <- 0 until points by every do out.put(xyz, point * PointBytes, PointBytes)
      out.array

  private def timestamp(at: Instant): Protobuf =
    val ns = at.toNanos.max(0)
    Protobuf().varint(1, ns / 1_000_000_000L).varint(2, ns % 1_000_000_000L)
