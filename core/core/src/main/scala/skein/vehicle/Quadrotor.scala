package skein.vehicle

import skein.units.Vector3

/** A quadrotor with its flight controller, as AirSim 1.8 simulates it by default (`FastPhysicsEngine`,
  * `RotorActuator`, SimpleFlight). Immutable: everything that changes is in a [[QuadrotorState]], so that any
  * number of vehicles and threads can share one instance.
  *
  * @param stepS duration of a step, s; AirSim's is 3 ms
  * @param cascade gains that a client has set; they replace those of `gains`
  */
final class Quadrotor(
    val airframe: Airframe = Airframe(),
    val gains: ControllerGains = ControllerGains(),
    val stepS: Double = Quadrotor.AirSimStepS,
    val cascade: Option[CascadeGains] = None
) extends Rotorcraft:
  import airframe.*

  private val controller =
    cascade.fold(FlightController(gains, stepS))(TunedFlightController(gains, _, stepS))
  private val rotorKeep      = FirstOrderLag(rotorTimeConstantS).remains(stepS)
  private val rollTorque     = rotorOffsetM * maxThrustN
  private val halfStep       = stepS / 2
  private val halfStepSquare = halfStep * halfStep

  /** Advances `state` by one step: forces, then the next kinematics, then the rotors' lag, then the
    * controller, which receives the new kinematics and sets the rotors. Deterministic; allocates nothing in
    * the air; about 0.13 µs. `QuadrotorGolden` compares it with AirSim's own step responses.
    */
  def step(state: QuadrotorState, setpoint: Setpoint, environment: Environment = Environment.Calm): Unit =
    if state.grounded then
      // Its thrust moves it from the next step on, as in AirSim.
      if lift(state, environment) >= massKg * Airframe.Gravity then state.grounded = false
      control(state, setpoint)
    else if state.z + (state.vz + halfStep * state.az) * stepS >= environment.groundDownM then
      val before = state.copy
      move(state, environment)
      if state.vz > 0 then touchGround(state, before, environment)
      control(state, setpoint)
    else stepInAir(state, setpoint, environment)

  /** [[step]] for a vehicle away from ground and obstacles: pure arithmetic, which is compiled to SIMD for
    * many vehicles.
    */
  private[skein] def stepInAir(state: QuadrotorState, setpoint: Setpoint, environment: Environment): Unit =
    move(state, environment)
    control(state, setpoint)

  private def control(state: QuadrotorState, setpoint: Setpoint): Unit =
    spinRotors(state)
    controller.update(state, setpoint)

  private def densityRatio(state: QuadrotorState, environment: Environment) =
    Atmosphere.densityRatio(environment.originAltitudeM - state.z)

  private def lift(state: QuadrotorState, environment: Environment) =
    (state.thrust0 + state.thrust1 + state.thrust2 + state.thrust3) * maxThrustN *
      densityRatio(state, environment)

  /** This vehicle with other gains. After the change, call [[QuadrotorState.restartController]] on a state of
    * the old vehicle. [[hovering]] still uses the original gains.
    */
  def tuned(cascade: CascadeGains): Quadrotor = Quadrotor(airframe, gains, stepS, Some(cascade))

  /** A vehicle that has held `goalNed` for long at this yaw, level and at rest, with its integrator settled.
    * It is [[hoverSagM]] below its goal, where a step under [[Setpoint.hold]] of that goal leaves it.
    */
  def hovering(
      goalNed: Vector3,
      yawRad: Double = 0.0,
      environment: Environment = Environment.Calm
  ): QuadrotorState =
    val state                     = atRest(goalNed, yawRad)
    val control                   = hoverControl(goalNed.z, environment)
    val (integral, velocityError) = controller.hoverIntegral(control)
    state.z = goalNed.z - velocityError / (gains.positionP * gains.maxVelocity)
    state.verticalIntegral = integral
    state.verticalMode = VerticalMode.Position
    state.control0 = control; state.control1 = control; state.control2 = control; state.control3 = control
    state.lagged0 = control; state.lagged1 = control; state.lagged2 = control; state.lagged3 = control
    state.thrust0 = control; state.thrust1 = control; state.thrust2 = control; state.thrust3 = control
    state

  /** A vehicle on the ground with its motors off. `positionNed` should lie on the environment's ground. */
  def landed(positionNed: Vector3, yawRad: Double = 0.0): QuadrotorState =
    val state = atRest(positionNed, yawRad)
    state.grounded = true
    state

  def land(state: QuadrotorState, yawRad: Double): Unit = state.copyFrom(landed(Vector3.Zero, yawRad))

  def hover(state: QuadrotorState, goalNed: Vector3, yawRad: Double, environment: Environment): Unit =
    state.copyFrom(hovering(goalNed, yawRad, environment))

  /** Distance below its altitude goal at which a hovering vehicle settles, m, caused by the discount of the
    * altitude integrator; 2.0 mm for AirSim's vehicle.
    */
  def hoverSagM(downM: Double, environment: Environment = Environment.Calm): Double =
    hovering(Vector3(0, 0, downM), 0.0, environment).z - downM

  /** The rotor control at which thrust balances weight. */
  def hoverControl(downM: Double, environment: Environment = Environment.Calm): Double =
    massKg * Airframe.Gravity /
      (4 * maxThrustN * Atmosphere.densityRatio(environment.originAltitudeM - downM))

  private def atRest(positionNed: Vector3, yawRad: Double): QuadrotorState =
    val state = QuadrotorState()
    state.x = positionNed.x; state.y = positionNed.y; state.z = positionNed.z
    state.qw = StrictMath.cos(yawRad / 2); state.qz = StrictMath.sin(yawRad / 2)
    state

  /** Advances the rotors by one step. As in AirSim, a rotor's output passes through two stages of one step
    * each, so a control acts two steps (6 ms in AirSim) later than the rotor's lag alone would cause. Step
    * responses show this delay.
    */
  private def spinRotors(state: QuadrotorState): Unit =
    state.thrust0 = state.lagged0; state.thrust1 = state.lagged1
    state.thrust2 = state.lagged2; state.thrust3 = state.lagged3
    state.lagged0 = state.control0 + (state.lagged0 - state.control0) * rotorKeep
    state.lagged1 = state.control1 + (state.lagged1 - state.control1) * rotorKeep
    state.lagged2 = state.control2 + (state.lagged2 - state.control2) * rotorKeep
    state.lagged3 = state.control3 + (state.lagged3 - state.control3) * rotorKeep

  /** Moves the vehicle by velocity Verlet in AirSim's form, with forces at the mean velocity of the step. */
  private def move(state: QuadrotorState, environment: Environment): Unit =
    import state.{qw, qx, qy, qz}
    val densityRatio = this.densityRatio(state, environment)
    val lift         = this.lift(state, environment)
    val vx           = state.vx + halfStep * state.ax
    val vy           = state.vy + halfStep * state.ay
    val vz           = state.vz + halfStep * state.az
    val wx           = state.wx + halfStep * state.wxDot
    val wy           = state.wy + halfStep * state.wyDot
    val wz           = state.wz + halfStep * state.wzDot

    val r00 = 1 - 2 * (qy * qy + qz * qz)
    val r10 = 2 * (qx * qy + qw * qz)
    val r20 = 2 * (qx * qz - qw * qy)
    val r01 = 2 * (qx * qy - qw * qz)
    val r11 = 1 - 2 * (qx * qx + qz * qz)
    val r21 = 2 * (qy * qz + qw * qx)
    val r02 = 2 * (qx * qz + qw * qy)
    val r12 = 2 * (qy * qz - qw * qx)
    val r22 = 1 - 2 * (qx * qx + qy * qy)

    // The faces' centres lie on the body's axes, so turning neither adds to their normal speed nor gets
    // torque.
    val density    = Atmosphere.SeaLevelDensity * densityRatio
    val airX       = vx - environment.windNed.x
    val airY       = vy - environment.windNed.y
    val airZ       = vz - environment.windNed.z
    val forceFront = drag(dragFront * density, r00 * airX + r10 * airY + r20 * airZ)
    val forceRight = drag(dragRight * density, r01 * airX + r11 * airY + r21 * airZ)
    val forceDown  = drag(dragDown * density, r02 * airX + r12 * airY + r22 * airZ) - lift

    val perKg = 1 / massKg
    val ax    = (r00 * forceFront + r01 * forceRight + r02 * forceDown) * perKg
    val ay    = (r10 * forceFront + r11 * forceRight + r12 * forceDown) * perKg
    val az    = (r20 * forceFront + r21 * forceRight + r22 * forceDown) * perKg + Airframe.Gravity

    import state.{thrust0, thrust1, thrust2, thrust3}
    val torqueFront = (-thrust0 + thrust1 + thrust2 - thrust3) * (rollTorque * densityRatio)
    val torqueRight = (thrust0 - thrust1 + thrust2 - thrust3) * (rollTorque * densityRatio)
    val torqueDown  = (thrust0 + thrust1 - thrust2 - thrust3) * (maxTorqueNm * densityRatio)
    val wxDot       = (torqueFront - wy * wz * (inertiaDown - inertiaRight)) / inertiaFront
    val wyDot       = (torqueRight - wz * wx * (inertiaFront - inertiaDown)) / inertiaRight
    val wzDot       = (torqueDown - wx * wy * (inertiaRight - inertiaFront)) / inertiaDown

    state.x += vx * stepS; state.y += vy * stepS; state.z += vz * stepS
    state.vx += (state.ax + ax) * halfStep
    state.vy += (state.ay + ay) * halfStep
    state.vz += (state.az + az) * halfStep
    state.ax = ax; state.ay = ay; state.az = az
    state.wx += (state.wxDot + wxDot) * halfStep
    state.wy += (state.wyDot + wyDot) * halfStep
    state.wz += (state.wzDot + wzDot) * halfStep
    state.wxDot = wxDot; state.wyDot = wyDot; state.wzDot = wzDot
    rotate(state, wx, wy, wz)

  /** Rotates the orientation by (wx, wy, wz)·stepS in the body frame. */
  private def rotate(state: QuadrotorState, wx: Double, wy: Double, wz: Double): Unit =
    import state.{qw, qx, qy, qz}
    // Half a step's angle h is far below 1 rad: two terms of cos h and sin h / h err below h⁶/720.
    val h2   = (wx * wx + wy * wy + wz * wz) * halfStepSquare
    val cos  = 1 - h2 * (1.0 / 2 - h2 * (1.0 / 24))
    val sinc = 1 - h2 * (1.0 / 6 - h2 * (1.0 / 120))
    val dx   = wx * halfStep * sinc
    val dy   = wy * halfStep * sinc
    val dz   = wz * halfStep * sinc
    val nw   = qw * cos - qx * dx - qy * dy - qz * dz
    val nx   = qw * dx + qx * cos + qy * dz - qz * dy
    val ny   = qw * dy - qx * dz + qy * cos + qz * dx
    val nz   = qw * dz + qx * dy - qy * dx + qz * cos
    val norm = 1 / math.sqrt(nw * nw + nx * nx + ny * ny + nz * nz)
    state.qw = nw * norm; state.qx = nx * norm; state.qy = ny * norm; state.qz = nz * norm

  private def drag(factor: Double, speed: Double): Double =
    if math.abs(speed) > dragMinSpeed then -factor * speed * math.abs(speed) else 0.0

  /** AirSim's collision response with flat ground, in place of the step. A vehicle that is nearly level and
    * moves down faster than sideways lands; any other bounces. The contact is at the centre of mass and
    * causes no rotation; in AirSim it is where the engine's shapes meet.
    */
  private[skein] def touchGround(
      state: QuadrotorState,
      before: QuadrotorState,
      environment: Environment
  ): Unit =
    import before.{qx, qy}
    val upright = 1 - 2 * (qx * qx + qy * qy)
    val vx      = before.vx + before.ax * stepS
    val vy      = before.vy + before.ay * stepS
    val vz      = before.vz + before.az * stepS
    state.contacts += 1
    state.x = before.x; state.y = before.y; state.z = environment.groundDownM
    state.ax = 0; state.ay = 0; state.az = 0
    state.wxDot = 0; state.wyDot = 0; state.wzDot = 0
    if vz > math.abs(vx) && vz > math.abs(vy) && math.abs(math.abs(upright) - 1) < Quadrotor.LevelTolerance
    then
      val yaw = before.yawRad
      state.grounded = true
      state.vx = 0; state.vy = 0; state.vz = 0
      state.wx = 0; state.wy = 0; state.wz = 0
      state.qw = StrictMath.cos(yaw / 2); state.qx = 0; state.qy = 0; state.qz = StrictMath.sin(yaw / 2)
    else
      state.vx = vx * (1 - friction); state.vy = vy * (1 - friction); state.vz = vz * -restitution
      state.x += state.vx * stepS; state.y += state.vy * stepS; state.z += state.vz * stepS
      state.wx = (before.wx + before.wxDot * stepS) * Quadrotor.BounceSpin
      state.wy = (before.wy + before.wyDot * stepS) * Quadrotor.BounceSpin
      state.wz = (before.wz + before.wzDot * stepS) * Quadrotor.BounceSpin
      state.qw = before.qw; state.qx = before.qx; state.qy = before.qy; state.qz = before.qz

object Quadrotor:
  val AirSimStepS = 0.003

  /** Maximum deviation of the tilt's cosine from 1 at a landing: AirSim's `kAxisTolerance`. */
  private val LevelTolerance = 0.25

  /** Share of the angular velocity that remains after a bounce: AirSim's rolling friction. */
  private val BounceSpin = 0.9

  val AirSim: Quadrotor = Quadrotor()
