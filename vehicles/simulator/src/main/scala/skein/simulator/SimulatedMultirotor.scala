package skein.simulator

import skein.airsim.wire.{CollisionInfo, KinematicsState, RcData, Vector3r}
import skein.airsim.VehicleSettings
import skein.scene.{Contact, Scene, SceneObject}
import skein.units.*
import skein.vehicle.*

/** One multirotor: its physics and the state that AirSim's SimpleFlight firmware keeps in addition
  * (`OffboardApi`).
  */
final private[simulator] class SimulatedMultirotor(
    settings: VehicleSettings,
    rotorcraft: Rotorcraft,
    worldOrigin: GeoLocation
) extends SimulatedVehicle(settings, worldOrigin):
  val state: QuadrotorState = QuadrotorState()

  private var tuned       = rotorcraft
  private var environment =
    Environment(groundDownM = math.max(0, -settings.startNed.z), originAltitudeM = home.altitude.value)
  private var goal        = Setpoint.Disarmed
  private var goalSetAt   = Instant.Epoch
  private var goalExpired = false
  private var armed       = settings.armed
  private var remote      = RcData.Absent
  private var flown       = false
  private var outside     = Option.empty[Setpoint]
  private var jumped      = 0L

  /** The last state of the remote control's sticks. */
  def sticks: RcData = remote

  def flying: Boolean = flown

  /** Number of resets and of positions set so far, which displace it without flight. */
  def jumps: Long = jumped

  def airframe: Airframe = rotorcraft.airframe

  reset(Instant.Epoch)

  def kind: String = "multirotor"

  /** Returns the vehicle to its start, without API control; armed if the settings say so. */
  def reset(at: Instant): Unit =
    rotorcraft.land(state, settings.yaw.value)
    jumped += 1
    state.grounded = environment.groundDownM == 0
    armed = settings.armed
    controlled = false
    remote = RcData.Absent
    goalExpired = false
    goalSetAt = at
    goal = remoteGoal
    begin(at)
    flown = false

  def setWind(windNed: Vector3): Unit = environment = environment.copy(windNed = windNed)

  def step(at: Instant, scene: Scene): Unit =
    if controlled && flown && !goalExpired && at.since(goalSetAt) > SimulatedMultirotor.GoalLifetime then
      goal = Setpoint.hold(state.positionNed)
      goalExpired = true
    val contacts = state.contacts
    tuned.step(state, outside.getOrElse(goal), environment)
    sampledAt = at
    if state.contacts > contacts then
      val here = Vector3r(state.positionNed)
      touched = Some(CollisionInfo(true, 0, at, Vector3r(0, 0, -1), here, here, Scene.Ground, -1))
    if scene.objects.nonEmpty then meet(scene, at)
    noticeTakeoffAndLanding()

  /** AirSim's response to a collision, with the contact at the centre of mass, so that it exerts no torque:
    * motion into the object bounces, motion along it is slowed, and a vehicle that descends more than it
    * slides comes to rest.
    */
  private def meet(scene: Scene, at: Instant): Unit =
    val centre = settings.startNed + state.positionNed
    for contact <- obstacles.touched(scene, centre, halfLengths)(state.orientation) do
      bounce(contact)
      meets(obstacles.told(scene, contact, at, state.positionNed))

  private def bounce(contact: Contact): Unit =
    val n        = contact.normal
    val inwards  = state.vx * n.x + state.vy * n.y + state.vz * n.z
    val lands    = n.z < -0.75 && state.vz > math.abs(state.vx) && state.vz > math.abs(state.vy)
    val returned = if lands then 0 else airframe.restitution
    val kept     = if lands then 0 else 1 - airframe.friction
    if inwards < 0 then
      state.vx = (state.vx - n.x * inwards) * kept - n.x * inwards * returned
      state.vy = (state.vy - n.y * inwards) * kept - n.y * inwards * returned
      state.vz = (state.vz - n.z * inwards) * kept - n.z * inwards * returned
      state.wx *= SimulatedMultirotor.SpinKept
      state.wy *= SimulatedMultirotor.SpinKept
      state.wz *= SimulatedMultirotor.SpinKept
      state.ax = 0; state.ay = 0; state.az = 0
      state.wxDot = 0; state.wyDot = 0; state.wzDot = 0
    state.x += n.x * contact.depthM
    state.y += n.y * contact.depthM
    state.z += n.z * contact.depthM

  /** Sets the goal, if the API has control; it holds for 60 ms. */
  def command(setpoint: Setpoint, at: Instant): Unit =
    if controlled then
      goal = setpoint
      goalSetAt = at
      goalExpired = false

  /** Lets an external autopilot fly the vehicle by a setpoint that holds until the next; None returns control
    * to AirSim's firmware.
    */
  def flyBy(autopilot: Option[Setpoint]): Unit = outside = autopilot

  /** Gives control to the API or takes it away. Either way the remote control then sets the goal, even if the
    * API already had control. A vehicle that held its position thus falls: the throttle of an absent remote
    * control is idle, and AirSim assumes that a vehicle at rest under it has landed, so position hold does
    * not catch it either.
    */
  def setApiControl(on: Boolean): Unit =
    controlled = on
    goal = remoteGoal

  /** Moves the sticks. They fly an armed vehicle without API control: angles (rates, if the first switch is
    * on), yaw rate and throttle. AirSim reads them only every 12 ms.
    */
  def steer(sticks: RcData): Unit =
    remote = sticks
    if !controlled then goal = remoteGoal

  /** Arms or disarms; only the API in control can, and only an armed vehicle can be disarmed. Arming an armed
    * vehicle changes nothing. Moves drive a disarmed vehicle too, as in AirSim.
    */
  def arm(on: Boolean): Boolean =
    val may = controlled && (on || armed)
    if may && on != armed then
      armed = on
      goal = if on then Setpoint.Armed else Setpoint.Disarmed
    may

  /** Moves the vehicle to a position in its own frame; velocity, goal and rotors stay unchanged, and it is in
    * the air.
    */
  def place(positionNed: Vector3, orientation: Quaternion, at: Instant): Unit =
    val sinceSample = positionAt(at) - state.positionNed
    state.place(positionNed - sinceSample, orientation.normalized)
    state.grounded = false
    jumped += 1

  /** Lets the vehicle hover at this position, level and at rest, with its controllers settled. It must be
    * above the ground and under API control.
    */
  def hoverAt(positionNed: Vector3, yawRad: Double, at: Instant): Unit =
    require(controlled && isAboveGround(positionNed), s"cannot hover at $positionNed")
    val hold = positionNed - Vector3(0, 0, rotorcraft.hoverSagM(positionNed.z, environment))
    rotorcraft.hover(state, hold, yawRad, environment)
    // Exactly there, independent of the rounding of hold and sag.
    state.place(positionNed, state.orientation)
    flown = true
    jumped += 1
    command(Setpoint.hold(hold), at)
    // An expired goal becomes this one, too.
    goalExpired = true
    sampledAt = at

  def isAboveGround(positionNed: Vector3): Boolean = positionNed.z < environment.groundDownM

  def gains: CascadeGains = tuned.cascade.getOrElse(CascadeGains.Default)

  def tune(gains: CascadeGains): Unit =
    tuned = rotorcraft.tuned(gains)
    state.restartController()

  /** Sets the vehicle's state of motion, in its own frame, bypassing its flight controller. The vehicle is
    * then in the air.
    */
  def setKinematics(kinematics: KinematicsState, at: Instant): Unit =
    val acceleration        = kinematics.linear_acceleration.toVector
    val angularVelocity     = kinematics.angular_velocity.toVector
    val angularAcceleration = kinematics.angular_acceleration.toVector
    // Physics is at the step before `at`: the stored state must extrapolate to this one.
    val s        = sinceSample(at)
    val velocity = kinematics.linear_velocity.toVector - acceleration * s
    val position = kinematics.position.toVector - velocity * s - acceleration * (s * s / 2)
    state.place(position, kinematics.orientation.toQuaternion.normalized)
    jumped += 1
    state.vx = velocity.x; state.vy = velocity.y; state.vz = velocity.z
    state.ax = acceleration.x; state.ay = acceleration.y; state.az = acceleration.z
    state.wx = angularVelocity.x; state.wy = angularVelocity.y; state.wz = angularVelocity.z
    state.wxDot = angularAcceleration.x
    state.wyDot = angularAcceleration.y
    state.wzDot = angularAcceleration.z
    state.grounded = false

  /** Half of its lengths, rotors included, m. */
  def halfLengths: Vector3 =
    val reach = airframe.rotorOffsetM + airframe.rotorDiameterM / 2
    Vector3(reach, reach, airframe.rotorDownM + airframe.rotorHeightM)

  def middleFrd: Vector3 = Vector3.Zero

  def parts(number: Int, tagM: Double): Vector[SceneObject.Part] =
    MultirotorBody.parts(airframe, number, tagM)

  def cameras: CameraSet = CameraSet.OfMultirotor

  def isGrounded: Boolean             = state.grounded
  def orientation: Quaternion         = state.orientation
  def angularVelocityFrd: Vector3     = state.angularVelocityFrd
  def accelerationNed: Vector3        = state.accelerationNed
  def angularAccelerationFrd: Vector3 = state.angularAccelerationFrd

  /** Position at `at`, up to one step after the last: extrapolated at constant acceleration, with an error
    * below 0.1 µm at 10 m/s³ of jerk.
    */
  def positionAt(at: Instant): Vector3 =
    val s = sinceSample(at)
    state.positionNed + state.velocityNed * s + state.accelerationNed * (s * s / 2)

  /** Velocity at `at`, extrapolated at constant acceleration. */
  def velocityAt(at: Instant): Vector3 = state.velocityNed + state.accelerationNed * sinceSample(at)

  /** The setpoint of the remote control's sticks; the sticks of an absent remote control are at zero. */
  private def remoteGoal: Setpoint =
    if !armed then Setpoint.Disarmed
    else
      val sticks   = if remote.is_valid then remote else RcData.Absent
      val tilt     = rotorcraft.gains.maxTilt
      val roll     = sticks.roll * tilt
      val pitch    = -sticks.pitch * tilt
      val throttle = math.max(sticks.throttle.toDouble, Setpoint.Armed.third)
      val yawRate  = sticks.yaw * math.Pi
      if (sticks.switches & 1) == 0 then
        Setpoint.anglesThrottle(roll, pitch, 0, throttle).withYawRate(yawRate)
      else Setpoint.ratesThrottle(roll, pitch, yawRate, throttle)

  private def noticeTakeoffAndLanding(): Unit =
    val driven =
      (state.control0 + state.control1 + state.control2 + state.control3) / 4 > SimulatedMultirotor.ArmedThrottle
    if !flown then flown = driven && math.abs(state.vz) > 0.01
    else if !driven && isStill then flown = false

  private def isStill: Boolean =
    Seq(state.vx, state.vy, state.vz, state.wx, state.wy, state.wz).forall(math.abs(_) < 0.08)

private[simulator] object SimulatedMultirotor:
  /** A goal that is not renewed within this time turns into position hold, once the vehicle flies. */
  val GoalLifetime: Span = Span.ofMillis(60)

  private val ArmedThrottle = 0.1

  /** Fraction of the angular velocity that remains after a bounce: AirSim's rolling friction. */
  private val SpinKept = 0.9
