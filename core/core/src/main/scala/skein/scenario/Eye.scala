package skein.scenario

import java.nio.ByteBuffer
import skein.fusion.{FusionSettings, PolarMeasurement}
import skein.signal.LatencyProfile
import skein.units.*

/** A camera with a recogniser, as a sensor of a policy: each detection of a target in an image updates an
  * estimate at the time of exposure. The policy reads the estimate as a sensor.
  *
  * @param vehicle whose camera it is
  * @param sensor the name under which the vehicle's policy reads the estimate: [[Eye.Columns]], valid at the
  *   newest detection's exposure
  * @param camera of the vehicle: AirSim's, or one of the scenario's equipment
  * @param target name of the vehicle to detect, for reports
  * @param every period of the images
  * @param recogniser makes an instance for each worker
  * @param takes duration of recognition: exact in virtual time, a minimum in live flights
  * @param workers number of images searched simultaneously
  * @param deadline for each image
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
  /** The estimate: the target's position and velocity, world NED, and the largest of the position's standard
    * deviations along north, east and down. Then the newest detection: its place in the camera's frame, how
    * long recognition took, and the camera's position and orientation. Last, how many images were searched
    * until then, and how many of them showed the target.
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

/** Detects one kind of object in images. May keep memory of its own; is never called by two threads
  * simultaneously.
  */
trait Recogniser:

  /** Searches an image.
    *
    * @param bgr blue, green, red of each pixel, in rows from the top
    * @return the detection, in the camera's frame; Left states why the image cannot be searched
    */
  def find(width: Int, height: Int, bgr: ByteBuffer): Either[String, Option[PolarMeasurement]]
