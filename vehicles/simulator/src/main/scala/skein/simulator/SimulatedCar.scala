package skein.simulator

import skein.airsim.VehicleSettings
import skein.airsim.wire.{CarControls as WireControls, KinematicsState}
import skein.scene.{Contact, Scene, SceneObject}
import skein.units.*
import skein.vehicle.{CarControls, CarState, SingleTrack}

/** One car: a [[skein.vehicle.SingleTrack]] on level ground at the height of its start, with one gear
  * forwards and one backwards. Its position is that of its centre of mass, on the ground.
  */
final private[simulator] class SimulatedCar(settings: VehicleSettings, worldOrigin: GeoLocation)
    extends SimulatedVehicle(settings, worldOrigin):
  private val car          = SingleTrack()
  private var state        = CarState(0, 0, settings.yaw.value)
  private var told         = WireControls()
  private var acceleration = Vector3.Zero
  private var yawing       = 0.0

  reset(Instant.Epoch)

  def kind: String = "car"

  def controls: WireControls = told

  /** Sets controls, which take effect while the API has control. */
  def setControls(controls: WireControls): Unit = told = controls

  /** Speed along its heading, m/s, negative in reverse. */
  def speedMps: Double = state.frontMps

  /** The gear: −1 in reverse, 0 at rest, else 1. */
  def gear: Int =
    if told.is_manual_gear then told.manual_gear.sign
    else if math.abs(speedMps) < SimulatedCar.StandsMps then 0
    else math.signum(speedMps).toInt

  def rpm: Double =
    math.abs(speedMps) / SimulatedCar.WheelM / (2 * math.Pi) * 60 * SimulatedCar.Ratio

  /** Changes API control; resets the controls, as AirSim's car does. */
  def setApiControl(on: Boolean): Unit =
    if on != controlled then told = WireControls()
    controlled = on

  /** Does nothing and returns true: AirSim's car accepts all arming. */
  def arm(on: Boolean): Boolean = true

  def reset(at: Instant): Unit =
    state = CarState(0, 0, settings.yaw.value)
    told = WireControls()
    acceleration = Vector3.Zero
    yawing = 0
    controlled = false
    begin(at)

  def setWind(windNed: Vector3): Unit = ()

  def step(at: Instant, scene: Scene): Unit =
    val dt     = at.since(sampledAt).toSeconds
    val before = state
    if dt > 0 then
      state = car.step(before, acting, dt)
      acceleration = (velocityOf(state) - velocityOf(before)) * (1 / dt)
      yawing = (state.yawRadPerS - before.yawRadPerS) / dt
    sampledAt = at
    if scene.objects.nonEmpty then meet(scene, at)

  /** Pushes the car out of an object that it has driven into, and stops it. */
  private def meet(scene: Scene, at: Instant): Unit =
    val centre = worldPosition(at) + middleFrd
    for contact <- obstacles.touched(scene, centre, halfLengths)(orientation) do
      val back = contact.normal * contact.depthM
      meets(obstacles.told(scene, contact, at, positionAt(at)))
      if hits(contact, velocityOf(state)) then
        state = CarState(state.northM + back.x, state.eastM + back.y, state.headingRad)
        acceleration = Vector3.Zero
        yawing = 0

  private def hits(contact: Contact, velocity: Vector3) =
    velocity.x * contact.normal.x + velocity.y * contact.normal.y <= 0

  /** Places the car on the ground, level, without lateral and vertical motion. */
  def place(positionNed: Vector3, orientation: Quaternion, at: Instant): Unit =
    put(positionNed, orientation, state.frontMps, at)

  def setKinematics(kinematics: KinematicsState, at: Instant): Unit =
    val orientation = kinematics.orientation.toQuaternion.normalized
    put(
      kinematics.position.toVector,
      orientation,
      orientation.toBody(kinematics.linear_velocity.toVector).x,
      at
    )

  private def put(positionNed: Vector3, orientation: Quaternion, speedMps: Double, at: Instant): Unit =
    val heading = orientation.normalized.yawRad
    state = CarState(positionNed.x, positionNed.y, heading, speedMps)
    // Physics is at the step before `at`: the stored state must extrapolate to this one.
    val drift = positionAt(at) - Vector3(positionNed.x, positionNed.y, 0)
    state = CarState(positionNed.x - drift.x, positionNed.y - drift.y, heading, speedMps)

  def flying: Boolean     = false
  def isGrounded: Boolean = false

  def positionAt(at: Instant): Vector3 =
    val now = stateAt(at)
    Vector3(now.northM, now.eastM, 0)

  def velocityAt(at: Instant): Vector3 = velocityOf(stateAt(at))

  def orientation: Quaternion         = Quaternion.ofYaw(state.headingRad)
  def angularVelocityFrd: Vector3     = Vector3(0, 0, state.yawRadPerS)
  def accelerationNed: Vector3        = acceleration
  def angularAccelerationFrd: Vector3 = Vector3(0, 0, yawing)

  def halfLengths: Vector3 = CarBody.half
  def middleFrd: Vector3   = CarBody.middle
  def cameras: CameraSet   = CameraSet.OfCar

  def parts(number: Int, tagM: Double): Vector[SceneObject.Part] = CarBody.parts

  private def stateAt(at: Instant): CarState =
    val s = sinceSample(at)
    if s > 0 then car.step(state, acting, s) else state

  private def velocityOf(state: CarState) = Vector3(state.northMps, state.eastMps, 0)

  /** The controls in effect: in a gear chosen by hand the throttle drives in the gear's direction; else a
    * negative throttle drives in reverse.
    */
  private def acting: CarControls =
    if !controlled then CarControls.Neutral
    else
      val throttle =
        if told.is_manual_gear then told.manual_gear.sign * math.abs(told.throttle) else told.throttle
      CarControls(throttle, told.steering, if told.handbrake then 1 else told.brake)

private[simulator] object SimulatedCar:
  /** Maximum engine speed of AirSim's car (`CarPawn`). */
  val MostRpm = 5700.0

  /** Engine turns for each turn of the wheels, PhysX's final drive, and the wheel radius of a BMW 320i, m. */
  private val Ratio  = 4.0
  private val WheelM = 0.344

  private val StandsMps = 0.05
