package skein.recognition

import boofcv.abst.fiducial.FiducialDetector
import boofcv.alg.distort.pinhole.LensDistortionPinhole
import boofcv.factory.fiducial.{ConfigHammingMarker, FactoryFiducial, HammingDictionary}
import boofcv.struct.calib.CameraPinhole
import boofcv.struct.image.GrayU8
import java.nio.ByteBuffer
import georegression.struct.se.Se3_F64
import skein.airsim.{Image, Pixels}
import skein.fusion.{Measurement, PolarMeasurement}
import skein.signal.Stamped
import skein.units.*

/** A camera without distortion, like AirSim's.
  *
  * @param fieldOfView horizontal field of view, AirSim's `FOV_Degrees`
  */
final case class Pinhole(width: Int, height: Int, fieldOfView: Radians):
  require(
    width > 0 && height > 0 && fieldOfView.value > 0 && fieldOfView.value < math.Pi,
    s"a camera has pixels and sees less than 180°: $this"
  )

  /** The focal length in pixels: the apparent width of an object as wide as its distance. */
  def focalPx: Double = width / 2.0 / StrictMath.tan(fieldOfView.value / 2)

/** A detected tag.
  *
  * @param positionFrd position of its middle in the camera's frame (front, right, down), m
  * @param facingFrd the direction that it faces: of unit length, away from its carrier
  * @param deviationPx standard deviation of its edges, in pixels
  */
final case class Tag(
    id: Long,
    positionFrd: Vector3,
    facingFrd: Vector3,
    camera: Pinhole,
    size: Metres,
    deviationPx: Double
):

  /** The tag as bearing and range. Azimuth and elevation have the edges' standard deviation; the range has
    * the relative deviation of the tag's apparent width.
    */
  def polar: PolarMeasurement =
    val angle   = Radians(deviationPx / camera.focalPx)
    val range   = positionFrd.norm
    val widthPx = camera.focalPx * size.value / range
    PolarMeasurement.of(
      positionFrd,
      (azimuth = angle, elevation = angle, range = Metres(range * deviationPx / widthPx))
    )

  /** The tag's position at the exposure, from the camera pose in the image. */
  def measured(image: Stamped[Image]): Measurement =
    polar.seenFrom(image.validAt, image.value.positionNed, image.value.orientation)

/** Finds AprilTags of the family 36h11 in raw images, by BoofCV. Keeps memory of its own: make one for each
  * thread.
  *
  * @param size size of the tags' black squares, from edge to edge
  * @param deviationPx standard deviation with which edges are found; `AprilTagsSuite` checks the default on
  *   rendered images
  */
final class AprilTags(camera: Pinhole, size: Metres, deviationPx: Double = AprilTags.DeviationPx):
  private val gray                               = GrayU8(camera.width, camera.height)
  private val inCamera                           = Se3_F64()
  private val detector: FiducialDetector[GrayU8] =
    val tags = AprilTags.dictionary()
    tags.targetWidth = size.value
    val made = FactoryFiducial.squareHamming(tags, null, classOf[GrayU8])
    val f    = camera.focalPx
    made.setLensDistortion(
      LensDistortionPinhole(
        CameraPinhole(f, f, 0, camera.width / 2.0, camera.height / 2.0, camera.width, camera.height)
      ),
      camera.width,
      camera.height
    )
    made

  /** All tags in an image; Left says why it does not match the camera. */
  def find(image: Image): Either[String, Vector[Tag]] = image.pixels match
    case Pixels.Bgr(bytes) => find(image.width, image.height, bytes.buffer)
    case other             => Left(s"expected raw pixels, got ${other.productPrefix}")

  /** @param bgr blue, green, red of each pixel, in rows from the top
    */
  def find(width: Int, height: Int, bgr: ByteBuffer): Either[String, Vector[Tag]] =
    if width == camera.width && height == camera.height && bgr.remaining == width * height * 3 then
      AprilTags.grayOf(bgr, gray.data)
      detector.detect(gray)
      Right(Vector.tabulate(detector.totalFound)(tag))
    else
      Left(
        s"expected ${camera.width} × ${camera.height} pixels of three " +
          s"bytes, got $width × $height in ${bgr.remaining} bytes"
      )

  private def tag(index: Int): Tag =
    detector.getFiducialToCamera(index, inCamera): Unit
    // BoofCV's camera: right, down, ahead.
    val (at, turned) = (inCamera.T, inCamera.R)
    val facing       = Vector3(turned.get(2, 2), turned.get(0, 2), turned.get(1, 2))
    val position     = Vector3(at.z, at.x, at.y)
    // A visible tag faces the camera.
    val seen = facing.x * position.x + facing.y * position.y + facing.z * position.z < 0
    Tag(
      detector.getId(index),
      position,
      if seen then facing else facing * -1,
      camera,
      size,
      deviationPx
    )

object AprilTags:
  /** The family 36h11: 587 tags, of 6 × 6 bits within a border of one. */
  def dictionary(): ConfigHammingMarker =
    ConfigHammingMarker.loadDictionary(HammingDictionary.APRILTAG_36h11)

  val DeviationPx: Double = 0.25

  /** Converts pixels to the 8-bit luma of BT.601. */
  private def grayOf(bgr: ByteBuffer, gray: Array[Byte]): Unit =
    var pixel = 0
    var at    = 0
    while pixel < gray.length do
      val blue  = bgr.get(at) & 0xff
      val green = bgr.get(at + 1) & 0xff
      val red   = bgr.get(at + 2) & 0xff
      gray(pixel) = ((29 * blue + 150 * green + 77 * red) >> 8).toByte
      pixel += 1
      at += 3
