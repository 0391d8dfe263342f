package skein.mujoco

import skein.units.Vector3
import skein.vehicle.{Environment, FlightController, HorizontalMode, Quadrotor, QuadrotorState, Setpoint}

/** A batch of bodies of one model. Between two steps a vehicle's state is its
  * [[skein.vehicle.QuadrotorState]], together with the state of the model's other moving parts; MuJoCo
  * computes the step. The ground is flat, with AirSim's contact.
  *
  * MuJoCo's world has x to the north, y to the west and z up; its body x to the front, y to the left and z
  * up. Wind moves the whole world: MuJoCo receives velocities relative to the air, whose density the model
  * states.
  */
private[mujoco] final class MujocoBodies(model: MujocoModel, count: Int):
  private val body                    = model.body
  private val batch                   = model.batch(count)
  private val reference               = Quadrotor(stepS = model.stepS)
  private val before                  = Array.fill(count)(QuadrotorState())
  private val isDirect                = Array.ofDim[Boolean](count)
  private val controls                = MujocoControls(body.actuators)
  private val (place0, speed0, told0) = (body.place.at, body.velocity.at, body.controls.at)
  private val stepS                   = model.stepS

  /** Sets a hovering state, as [[skein.vehicle.Rotorcraft.hover]] specifies. */
  def hover(place: Int, state: QuadrotorState, goalNed: Vector3, yawRad: Double): Unit =
    state.copyFrom(reference.hovering(goalNed, yawRad, seaLevelAt(goalNed.z)))
    batch.setRow(place, body.hoveringRow)
    isDirect(place) = false

  def land(place: Int, state: QuadrotorState, yawRad: Double): Unit =
    state.copyFrom(reference.landed(Vector3.Zero, yawRad))
    batch.setRow(place, body.standingRow)
    isDirect(place) = false

  def hoverSagM(downM: Double): Double = reference.hoverSagM(downM, seaLevelAt(downM))

  /** Writes a step's initial state into the batch. */
  def begin(place: Int, state: QuadrotorState, environment: Environment): Unit =
    before(place).copyFrom(state)
    val told = controls.of(state, isDirect(place))
    if !state.grounded then
      val wind = environment.windNed
      batch(place, place0) = state.x
      batch(place, place0 + 1) = -state.y
      batch(place, place0 + 2) = heightM(state.z, environment)
      batch(place, place0 + 3) = state.qw
      batch(place, place0 + 4) = state.qx
      batch(place, place0 + 5) = -state.qy
      batch(place, place0 + 6) = -state.qz
      batch(place, speed0) = state.vx - wind.x
      batch(place, speed0 + 1) = wind.y - state.vy
      batch(place, speed0 + 2) = wind.z - state.vz
      batch(place, speed0 + 3) = state.wx
      batch(place, speed0 + 4) = -state.wy
      batch(place, speed0 + 5) = -state.wz
      // MuJoCo resets a diverging state; its time shows that.
      batch(place, body.time.at) = Running
      var i = 0
      while i < told.length do
        batch(place, told0 + i) = told(i)
        i += 1
      batch.mark(place)
    else if body.actuators.lifts(told) then state.grounded = false

  /** Steps the bodies that are in the air. */
  def step(): Unit = batch.step()

  /** Reads the state after the step, and lets the controller set the next controls. */
  def end(
      place: Int,
      state: QuadrotorState,
      setpoint: Setpoint,
      environment: Environment,
      controller: FlightController
  ): Unit =
    val was = before(place)
    if !was.grounded then
      if batch(place, body.time.at) < Running then
        throw IllegalStateException(s"${model.text}: its motion has diverged; expected a shorter timestep")
      val wind = environment.windNed
      state.x = batch(place, place0) + wind.x * stepS
      state.y = -batch(place, place0 + 1) + wind.y * stepS
      state.z = heightM(batch(place, place0 + 2), environment) + wind.z * stepS
      state.qw = batch(place, place0 + 3)
      state.qx = batch(place, place0 + 4)
      state.qy = -batch(place, place0 + 5)
      state.qz = -batch(place, place0 + 6)
      state.vx = batch(place, speed0) + wind.x
      state.vy = wind.y - batch(place, speed0 + 1)
      state.vz = wind.z - batch(place, speed0 + 2)
      state.wx = batch(place, speed0 + 3)
      state.wy = -batch(place, speed0 + 4)
      state.wz = -batch(place, speed0 + 5)
      state.ax = (state.vx - was.vx) / stepS
      state.ay = (state.vy - was.vy) / stepS
      state.az = (state.vz - was.vz) / stepS
      state.wxDot = (state.wx - was.wx) / stepS
      state.wyDot = (state.wy - was.wy) / stepS
      state.wzDot = (state.wz - was.wz) / stepS
      if state.z >= environment.groundDownM && state.vz > 0 then
        reference.touchGround(state, was, environment)
    controller.update(state, setpoint)
    isDirect(place) = setpoint.horizontal eq HorizontalMode.Rotors
    state.thrust0 = state.control0; state.thrust1 = state.control1
    state.thrust2 = state.control2; state.thrust3 = state.control3

  /** Converts between the down coordinate and the model's height, in either direction. */
  private def heightM(down: Double, environment: Environment) =
    body.standsAtM + environment.groundDownM - down

  private def seaLevelAt(downM: Double) = Environment(originAltitudeM = downM)

  /** A time above 0, s: a state that was reset has 0. */
  private inline val Running = 1.0
