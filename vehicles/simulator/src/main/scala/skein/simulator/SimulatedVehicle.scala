package skein.simulator

import skein.airsim.VehicleSettings
import skein.airsim.wire.KinematicsState
import skein.scene.{Scene, SceneObject}
import skein.units.*

/** One vehicle of the simulator. All positions are in its own frame, whose origin is its start.
  *
  * Changed by [[World]] alone.
  *
  * @param worldOrigin of the world's NED frame on the globe
  */
private[simulator] abstract class SimulatedVehicle(val settings: VehicleSettings, worldOrigin: GeoLocation):
  /** The start on the globe. */
  val home: GeoLocation = worldOrigin.locate(settings.startNed)

  protected var sampledAt: Instant     = Instant.Epoch
  protected var resetAt: Instant       = Instant.Epoch
  private var gpsFrom: Instant         = Instant.Epoch
  protected var controlled: Boolean    = false
  protected var touched: Option[Touch] = None
  protected val obstacles: Obstacles   = Obstacles(settings.startNed)

  /** A word for what it is. */
  def kind: String

  def apiControl: Boolean = controlled

  /** Gives control to the API or takes it away. */
  def setApiControl(on: Boolean): Unit

  /** Whether it did. */
  def arm(on: Boolean): Boolean

  /** Back to the start, without api control. */
  def reset(at: Instant): Unit

  def setWind(windNed: Vector3): Unit

  /** One step of physics and of what is on board, which ends at `at`. */
  def step(at: Instant, scene: Scene): Unit

  /** Puts it elsewhere, in its own frame; its motion stays as it is. */
  def place(positionNed: Vector3, orientation: Quaternion, at: Instant): Unit

  /** Puts it into this state of motion, in its own frame. */
  def setKinematics(kinematics: KinematicsState, at: Instant): Unit

  /** Whether it has taken off and not landed since. */
  def flying: Boolean

  /** Whether the ground carries it, and physics does not move it. */
  def isGrounded: Boolean

  /** Position at `at`, up to one step after the last. */
  def positionAt(at: Instant): Vector3

  /** Velocity at `at`, carried on likewise. */
  def velocityAt(at: Instant): Vector3

  def orientation: Quaternion
  def angularVelocityFrd: Vector3
  def accelerationNed: Vector3
  def angularAccelerationFrd: Vector3

  /** Half of the lengths of the box around it to the front, right and down, m. */
  def halfLengths: Vector3

  /** The middle of that box, on the vehicle, front right down, m. */
  def middleFrd: Vector3

  /** What it looks like.
    *
    * @param number of the vehicle in its world
    * @param tagM side of the tags on it; 0 for none
    */
  def parts(number: Int, tagM: Double): Vector[SceneObject.Part]

  /** What it carries without being told to. */
  def cameras: CameraSet

  /** Position at `at` in the world, m. */
  def worldPosition(at: Instant): Vector3 = settings.startNed + positionAt(at)

  /** The last touch of the ground or of an object since this was called before. */
  def takeTouch(): Option[Touch] =
    val last = touched
    touched = None
    last

  def locationAt(at: Instant): GeoLocation = home.locate(positionAt(at))

  /** Time since its start or its last reset. */
  def upFor(at: Instant): Span = at.since(resetAt)

  /** Whether its GPS tells anything: from a second after the start on, also after a reset, which does not
    * take that second again unless it comes before it is over.
    */
  def hasGps(at: Instant): Boolean = at >= gpsFrom

  /** It is there from now on, at its start. */
  def start(at: Instant): Unit =
    gpsFrom = at + SimulatedVehicle.GpsStartup
    reset(at)

  /** What every kind of vehicle notes of a reset. */
  protected def begin(at: Instant): Unit =
    if !hasGps(at) then gpsFrom = at + SimulatedVehicle.GpsStartup
    sampledAt = at
    resetAt = at
    touched = None

  protected def sinceSample(at: Instant): Double = at.since(sampledAt).toSeconds

private object SimulatedVehicle:
  /** Until a GPS that has been switched on tells anything. */
  val GpsStartup: Span = Span.ofSeconds(1)
