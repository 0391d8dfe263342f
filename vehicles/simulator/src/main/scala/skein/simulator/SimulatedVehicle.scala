package skein.simulator

import skein.airsim.VehicleSettings
import skein.airsim.wire.{CollisionInfo, KinematicsState}
import skein.scene.{Scene, SceneObject}
import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.NoisySensor

/** One vehicle of the simulator. All positions are in its own frame, whose origin is its start.
  *
  * Only [[World]] changes it.
  *
  * @param worldOrigin geographic origin of the world's NED frame
  */
private[simulator] abstract class SimulatedVehicle(val settings: VehicleSettings, worldOrigin: GeoLocation):
  val home: GeoLocation = worldOrigin.locate(settings.startNed)

  protected var sampledAt: Instant             = Instant.Epoch
  protected var resetAt: Instant               = Instant.Epoch
  private var gpsFrom: Instant                 = Instant.Epoch
  protected var controlled: Boolean            = false
  protected var touched: Option[CollisionInfo] = None
  private var lastMet: Option[CollisionInfo]   = None
  private var met                              = 0L
  protected val obstacles: Obstacles           = Obstacles(settings.startNed)
  private var startedAt                        = Instant.Epoch
  private var sensor                           = Option.empty[NoisySensor]
  private var isSensing                        = () => true
  private var lastSensed                       = Option.empty[Sensed]

  /** The vehicle's kind as a word, for messages. */
  def kind: String

  def apiControl: Boolean = controlled

  /** Gives control to the API or takes it away. */
  def setApiControl(on: Boolean): Unit

  /** Arms or disarms; returns whether it succeeded. */
  def arm(on: Boolean): Boolean

  /** Returns the vehicle to its start, without API control. */
  def reset(at: Instant): Unit

  def setWind(windNed: Vector3): Unit

  /** Advances physics and everything on board by one step, which ends at `at`. */
  def step(at: Instant, scene: Scene): Unit

  /** Moves the vehicle to a position in its own frame; its velocity is kept. */
  def place(positionNed: Vector3, orientation: Quaternion, at: Instant): Unit

  /** Sets the vehicle's state of motion, in its own frame. */
  def setKinematics(kinematics: KinematicsState, at: Instant): Unit

  /** Whether the vehicle has taken off and not landed since. */
  def flying: Boolean

  /** Whether the vehicle stands on the ground, so that physics does not move it. */
  def isGrounded: Boolean

  /** Position at `at`, up to one step after the last. */
  def positionAt(at: Instant): Vector3

  /** Velocity at `at`, up to one step after the last. */
  def velocityAt(at: Instant): Vector3

  def orientation: Quaternion
  def angularVelocityFrd: Vector3
  def accelerationNed: Vector3
  def angularAccelerationFrd: Vector3

  /** Half of its bounding box's lengths to the front, right and down, m. */
  def halfLengths: Vector3

  /** The middle of its bounding box, in its frame, front right down, m. */
  def middleFrd: Vector3

  /** Its shape as parts.
    *
    * @param number the vehicle's number in its world
    * @param tagM side of the tags on it; 0 for none
    */
  def parts(number: Int, tagM: Double): Vector[SceneObject.Part]

  /** The cameras that its kind carries by default. */
  def cameras: CameraSet

  /** The true motion at `at`, up to one step after the last. */
  def truth(at: Instant): Sensed = Sensed(motionAt(at), accelerationNed, angularAccelerationFrd, at)

  /** The vehicle's true motion, in its own frame. */
  def motionAt(at: Instant): Kinematics =
    Kinematics(positionAt(at), velocityAt(at), orientation, angularVelocityFrd)

  /** The motion at `at` as the vehicle's sensors report it. Where they have no reading, it is the last one,
    * or the first one there is.
    *
    * @param mayMiss whether the sensors may have no reading. While the simulator is paused, none would ever
    *   follow
    */
  def sensed(at: Instant, mayMiss: Boolean = true): Sensed = sensor.filter(_ => isSensing()) match
    case None          => truth(at)
    case Some(sensors) =>
      val age = at.since(startedAt)
      lastSensed.filter(_ => mayMiss && sensors.isMissing(age)).map(_.copy(isMissing = true)).getOrElse:
        val real   = truth(at)
        val sensed = real.copy(motion = sensors.read(real.motion, age))
        lastSensed = Some(sensed)
        sensed

  def worldPosition(at: Instant): Vector3 = settings.startNed + positionAt(at)

  /** The vehicle's true motion; its position is one in the world, NED. */
  def worldMotion(at: Instant): Kinematics = inWorld(motionAt(at))

  /** A motion in the vehicle's own frame with its position in the world, NED. */
  def inWorld(own: Kinematics): Kinematics = own.copy(positionNed = settings.startNed + own.positionNed)

  /** Contacts with objects of the scene so far, the ground aside. Touches of one object within
    * [[SimulatedVehicle.OneContact]] of each other are one contact.
    */
  def contacts: Long = met

  protected def meets(touch: CollisionInfo): Unit =
    if !lastMet.exists(last =>
        last.object_name == touch.object_name &&
          touch.time_stamp.since(last.time_stamp) <= SimulatedVehicle.OneContact
      )
    then met += 1
    lastMet = Some(touch)
    touched = lastMet

  /** Takes the last touch of the ground or of an object since the last call. */
  def takeTouch(): Option[CollisionInfo] =
    val last = touched
    touched = None
    last

  def locationAt(at: Instant): GeoLocation = home.locate(positionAt(at))

  def upFor(at: Instant): Span = at.since(resetAt)

  /** Whether the vehicle's GPS reports: from a second after the start on. A reset restarts that second only
    * while it is not over.
    */
  def hasGps(at: Instant): Boolean = at >= gpsFrom

  /** Starts the vehicle's clocks: it exists from this time on.
    *
    * @param sensing errors of its readings; without it they are true
    * @param index the vehicle's number in its world
    */
  def start(at: Instant, sensing: Option[SimulatedSensing], index: Int): Unit =
    startedAt = at
    sensor = sensing.map(_.sensor(index))
    for errors <- sensing do isSensing = errors.isOn
    gpsFrom = at + SimulatedVehicle.GpsStartup
    reset(at)

  /** Resets the state that all kinds of vehicles share. */
  protected def begin(at: Instant): Unit =
    if !hasGps(at) then gpsFrom = at + SimulatedVehicle.GpsStartup
    sampledAt = at
    resetAt = at
    touched = None
    lastSensed = None

  protected def sinceSample(at: Instant): Double = at.since(sampledAt).toSeconds

private object SimulatedVehicle:
  /** Time from the start until the GPS reports, as in AirSim. */
  val GpsStartup: Span = Span.ofSeconds(1)

  /** Touches of one object within this time of each other are one contact, as in a flight's recording. */
  val OneContact: Span = Span.ofMillis(500)
