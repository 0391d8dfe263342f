package skein.airsim.simulator

import skein.airsim.wire.RcData
import skein.airsim.{GeoLocation, VehicleSettings}
import skein.units.*
import skein.vehicle.*

/** One multirotor of the simulator: its physics and what AirSim's SimpleFlight firmware keeps beside them
  * (`OffboardApi`). All positions are in its own frame, whose origin is its start.
  *
  * Changed by [[World]] alone.
  *
  * @param worldOrigin
  *   of the world's NED frame on the globe
  */
final private[simulator] class SimulatedVehicle(
    val settings: VehicleSettings,
    quadrotor: Quadrotor,
    worldOrigin: GeoLocation
):
  /** The start on the globe. */
  val home: GeoLocation = Globe.locate(settings.startNed, worldOrigin)

  val state: QuadrotorState = quadrotor.landed(Vector3.Zero, settings.yaw.value)

  private var environment =
    Environment(groundDownM = math.max(0, -settings.startNed.z), originAltitudeM = home.altitude.value)
  private var sampledAt   = Instant.Epoch
  private var goal        = Setpoint.Disarmed
  private var goalSetAt   = Instant.Epoch
  private var goalExpired = false
  private var armed       = false
  private var controlled  = false
  private var remote      = RcData.Absent
  private var touched     = Option.empty[Touch]
  private var flown       = false

  def apiControl: Boolean = controlled

  /** The remote control's sticks as last heard of. */
  def sticks: RcData = remote

  /** Whether it has taken off and not landed since: AirSim's landed state. */
  def flying: Boolean = flown

  def airframe: Airframe = quadrotor.airframe

  /** Of the air here over that at sea level. */
  def densityRatio: Double = Atmosphere.densityRatio(environment.originAltitudeM - state.z)

  reset(Instant.Epoch)

  /** Back to the start, motors off. */
  def reset(at: Instant): Unit =
    state.copyFrom(quadrotor.landed(Vector3.Zero, settings.yaw.value))
    state.grounded = environment.groundDownM == 0
    sampledAt = at
    armed = false
    controlled = false
    remote = RcData.Absent
    goalExpired = false
    goalSetAt = at
    goal = Setpoint.Disarmed
    touched = None
    flown = false

  def setWind(windNed: Vector3): Unit = environment = environment.copy(windNed = windNed)

  /** One step of physics and firmware, which ends at `at`. */
  def step(at: Instant): Unit =
    if controlled && flown && !goalExpired && at.since(goalSetAt) > SimulatedVehicle.GoalLifetime then
      goal = Setpoint.hold(state.positionNed)
      goalExpired = true
    val stood = state.grounded
    val sank  = state.vz
    quadrotor.step(state, goal, environment)
    sampledAt = at
    if !stood && (state.grounded || state.vz < 0 && sank > 0 && state.z >= environment.groundDownM) then
      touched = Some(Touch(at, state.positionNed))
    noticeTakeoffAndLanding()

  /** Sets the goal, if the API has control; it holds for 60 ms. */
  def command(setpoint: Setpoint, at: Instant): Unit =
    if controlled then
      goal = setpoint
      goalSetAt = at
      goalExpired = false

  def setApiControl(on: Boolean): Unit =
    controlled = on
    goal = idleGoal

  /** Moves the sticks. They fly an armed vehicle that the API does not control: angles, yaw rate and throttle. */
  def steer(sticks: RcData): Unit =
    remote = sticks
    if !controlled then goal = idleGoal

  /** Arms or disarms; only the API in control can. */
  def arm(on: Boolean): Boolean =
    val may = controlled && (on || armed)
    if may then
      armed = on
      goal = idleGoal
    may

  /** Puts it at rest at this pose. In the air it hovers there as if it had long done so, if the API has control; else
    * it falls.
    */
  def place(positionNed: Vector3, orientation: Quaternion, at: Instant): Unit =
    val yaw = 2 * StrictMath.atan2(orientation.z, orientation.w)
    if positionNed.z < environment.groundDownM then
      val hold = positionNed - Vector3(0, 0, quadrotor.hoverSagM(positionNed.z, environment))
      state.copyFrom(quadrotor.hovering(hold, yaw, environment))
      flown = true
      command(Setpoint.hold(hold), at)
      // This goal is already what an expired one becomes.
      goalExpired = controlled
    else
      state.copyFrom(quadrotor.landed(positionNed, yaw))
      flown = false
    state.place(positionNed, Frames.normalized(orientation))
    sampledAt = at

  /** The last touch of the ground since this was called before. */
  def takeTouch(): Option[Touch] =
    val last = touched
    touched = None
    last

  /** Position at `at`, up to one step after the last: carried on at constant acceleration, which errs by less than
    * 0.1 µm at 10 m/s³ of jerk.
    */
  def positionAt(at: Instant): Vector3 =
    val s = sinceSample(at)
    state.positionNed + state.velocityNed * s + state.accelerationNed * (s * s / 2)

  /** Velocity at `at`, carried on likewise. */
  def velocityAt(at: Instant): Vector3 = state.velocityNed + state.accelerationNed * sinceSample(at)

  def locationAt(at: Instant): GeoLocation = Globe.locate(positionAt(at), home)

  private def sinceSample(at: Instant): Double = at.since(sampledAt).toSeconds

  /** The goal while no move gives one. */
  private def idleGoal: Setpoint =
    if !armed then Setpoint.Disarmed
    else if controlled || !remote.is_valid then Setpoint.Armed
    else
      val tilt = quadrotor.gains.maxTilt
      Setpoint
        .anglesThrottle(
          remote.roll * tilt,
          -remote.pitch * tilt,
          0,
          math.max(remote.throttle.toDouble, Setpoint.Armed.third)
        )
        .withYawRate(remote.yaw * math.Pi)

  private def noticeTakeoffAndLanding(): Unit =
    val driven =
      (state.control0 + state.control1 + state.control2 + state.control3) / 4 > SimulatedVehicle.ArmedThrottle
    if !flown then flown = driven && math.abs(state.vz) > 0.01
    else if !driven && isStill then flown = false

  private def isStill: Boolean =
    Seq(state.vx, state.vy, state.vz, state.wx, state.wy, state.wz).forall(math.abs(_) < 0.08)

/** Where and when a vehicle touched the ground, in its own frame. */
final private[simulator] case class Touch(at: Instant, positionNed: Vector3)

private[simulator] object SimulatedVehicle:
  /** A goal that no command renews within this turns into position hold, once the vehicle flies. */
  val GoalLifetime: Span = Span.ofMillis(60)

  private val ArmedThrottle = 0.1
