package skein.scenario

import java.nio.ByteBuffer
import skein.fusion.{FusionSettings, Sighting}
import skein.signal.LatencyProfile
import skein.units.*

/** How the policy of one vehicle knows of something by a camera alone: pictures are taken, something is recognised in them,
  * and what is found joins the belief at the moment of its exposure. The policy reads the belief as a sensor.
  *
  * @param vehicle
  *   who looks
  * @param sensor
  *   under which its policy reads what is believed: [[Eye.Columns]], valid at the newest detection's exposure
  * @param camera
  *   of the vehicle: AirSim's, or one of the scenario's equipment
  * @param target
  *   whom it looks for, for reports
  * @param every
  *   between two pictures
  * @param recogniser
  *   makes one for each worker
  * @param takes
  *   how long recognition takes, if it is not slower by itself: in virtual time that is how long it takes
  * @param workers
  *   pictures that are looked at side by side
  * @param deadline
  *   of each picture
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
  /** What is believed: where it was and how it moved, world NED, and the position's standard deviation along north,
    * east or down, the largest. Then of the newest detection: where it was seen in the camera's frame, how long recognition took, and
    * where the camera was, with its orientation. Last, how many pictures were looked at until then, and in how many
    * something was found.
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

/** Looks for one thing in pictures. May keep memory of its own; is never called by two threads at once. */
trait Recogniser:

  /** @param bgr
    *   blue, green, red of each pixel, in rows from the top
    * @return
    *   what was found, in the camera's frame; or why this is no picture to look at
    */
  def find(width: Int, height: Int, bgr: ByteBuffer): Either[String, Option[Sighting]]
