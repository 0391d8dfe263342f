package skein.forward

import skein.port.Moves
import skein.units.{Quaternion, Vector3}
import skein.vehicle.{Environment, Quadrotor, QuadrotorState, Rotorcraft, Setpoint}

/** AirSim's quadrotor, commanded by `moveByVelocityZ` at its start altitude, as in the built-in simulator
  * (`skein.simulator.SimulatedVehicle`): physics advances in whole steps from the time at which the vehicle
  * was placed at its start; a command takes effect at the first step after it. Commands are 32-bit floats on
  * AirSim's wire; [[SteppedVehicle]] defines the readings.
  */
private[skein] final class QuadrotorResponse(val quadrotor: Quadrotor, val hoveredS: Double)
    extends VelocityResponse:
  def create(): Vehicle = QuadrotorVehicle(quadrotor, Nanos.of(hoveredS))

  override def handoverS: Double = Moves.Handover.toSeconds

private[skein] final class QuadrotorVehicle(quadrotor: Rotorcraft, hoveredNs: Long) extends SteppedVehicle:
  private val stepNs             = Nanos.of(quadrotor.stepS)
  private val state              = QuadrotorState()
  private var setpoint: Setpoint = Setpoint.Disarmed
  private var down               = 0.0

  // Since it was put to its start, ns.
  private var now, steppedTo = 0L

  def start(x: Double, y: Double, z: Double): Unit =
    originX = x; originY = y; down = z
    val hold = Vector3(0, 0, z - quadrotor.hoverSagM(z))
    quadrotor.hover(state, hold, 0, Environment.Calm)
    state.place(Vector3(0, 0, z), Quaternion.Identity)
    setpoint = Setpoint.hold(hold)
    now = 0; steppedTo = 0
    advance(0)

  def command(vx: Double, vy: Double): Unit =
    setpoint = Setpoint.velocityZ(vx.toFloat, vy.toFloat, down.toFloat)

  def advance(timeS: Double): Unit =
    now = hoveredNs + Nanos.of(timeS)
    while steppedTo + stepNs <= now do
      quadrotor.step(state, setpoint, Environment.Calm)
      steppedTo += stepNs

  protected def sinceStepS: Double = (now - steppedTo) * 1e-9

  protected def stepX: Double  = state.x
  protected def stepY: Double  = state.y
  protected def stepZ: Double  = state.z
  protected def stepVx: Double = state.vx
  protected def stepVy: Double = state.vy
  protected def stepVz: Double = state.vz
  protected def stepAx: Double = state.ax
  protected def stepAy: Double = state.ay
  protected def stepAz: Double = state.az

  protected def orientation: Quaternion =
    Quaternion(state.qw.toFloat, state.qx.toFloat, state.qy.toFloat, state.qz.toFloat)
  protected def angularVelocityFrd: Vector3 = Vector3(state.wx.toFloat, state.wy.toFloat, state.wz.toFloat)
