package skein.scenario

import java.nio.ByteBuffer
import skein.fusion.{FusionSettings, PolarMeasurement}
import skein.signal.LatencyProfile
import skein.units.*

/** A camera with a recogniser, as a sensor for a policy. Each detection of a target in an image updates an
  * estimate at the time of exposure; the policy reads this estimate.
  *
  * @param vehicle name of the vehicle with the camera
  * @param sensor name under which the vehicle's policy reads the estimate: [[Eye.Columns]], valid at the
  *   newest detection's exposure
  * @param camera name of one of the vehicle's cameras: a camera of AirSim, or of the scenario's equipment
  * @param target name of the vehicle to detect, for reports
  * @param every period of the images
  * @param recogniser creates an instance for each worker
  * @param takes duration of recognition: exact in virtual time, a minimum in live flights
  * @param workers number of images that are searched simultaneously
  * @param deadline time limit for each image's result
  */
final case class Eye(
    vehicle: String,
    sensor: String,
    camera: String,
    target: String,
    every: Span,
    recogniser: () => Recogniser,
    takes: LatencyProfile,
    workers: Int = 2,
    deadline: Span = Span.ofMillis(300),
    fusion: FusionSettings = FusionSettings()
)

object Eye:
  /** The columns. First the estimate: the target's position and velocity, world NED, and the largest standard
    * deviation of the position along north, east and down. Then the newest detection: its position in the
    * camera's frame, the duration of recognition, and the camera's position and orientation. Last, the number
    * of images searched until then, and the number of images with a detection.
    */
  val Columns: Vector[String] = Vector(
    "northM",
    "eastM",
    "downM",
    "northMps",
    "eastMps",
    "downMps",
    "positionSdM",
    "azimuthRad",
    "elevationRad",
    "rangeM",
    "tookMs",
    "cameraNorthM",
    "cameraEastM",
    "cameraDownM",
    "cameraW",
    "cameraX",
    "cameraY",
    "cameraZ",
    "pictures",
    "found"
  )

/** Detects one kind of object in images. It may have state; it is never called by two threads simultaneously.
  */
trait Recogniser:

  /** Searches an image.
    *
    * @param bgr blue, green, red of each pixel, in rows from the top
    * @return the detection, in the camera's frame; Left says why the image cannot be searched
    */
  def find(width: Int, height: Int, bgr: ByteBuffer): Either[String, Option[PolarMeasurement]]
