package skein.forward

import skein.port.Moves
import skein.signal.Kinematics
import skein.units.{Quaternion, Vector3}
import skein.vehicle.{Environment, Quadrotor, QuadrotorState, Rotorcraft, Setpoint}

/** AirSim's quadrotor, commanded by `moveByVelocityZ` at its start altitude, as the built-in simulator flies
  * it (`skein.simulator.SimulatedVehicle`): physics keeps a grid of whole steps, from when the vehicle was
  * put to its start; a command acts from the first step after it on; a position between two steps is carried
  * on from the last. What is read and commanded are 32-bit floats on AirSim's wire, positions in the frame
  * whose origin is the start.
  */
private[skein] final class QuadrotorResponse(val quadrotor: Quadrotor, val hoveredS: Double)
    extends VelocityResponse:
  def create(): Vehicle = QuadrotorVehicle(quadrotor, Nanos.of(hoveredS))

  override def handoverS: Double = Moves.Handover.toSeconds

private[skein] final class QuadrotorVehicle(quadrotor: Rotorcraft, hoveredNs: Long) extends Vehicle:
  private val stepNs             = Nanos.of(quadrotor.stepS)
  private val state              = QuadrotorState()
  private var setpoint: Setpoint = Setpoint.Disarmed
  private var originX, originY   = 0.0
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

  def x: Double  = originX + ownX
  def y: Double  = originY + ownY
  def vx: Double = state.vx + state.ax * sinceStep
  def vy: Double = state.vy + state.ay * sinceStep

  override def seenX: Double  = ownX.toFloat + originX
  override def seenY: Double  = ownY.toFloat + originY
  override def seenVx: Double = vx.toFloat
  override def seenVy: Double = vy.toFloat

  override def seen: Kinematics =
    val t = sinceStep
    Kinematics(
      Vector3(seenX, seenY, (state.z + state.vz * t + state.az * (t * t / 2)).toFloat),
      Vector3(seenVx, seenVy, (state.vz + state.az * t).toFloat),
      Quaternion(state.qw.toFloat, state.qx.toFloat, state.qy.toFloat, state.qz.toFloat),
      Vector3(state.wx.toFloat, state.wy.toFloat, state.wz.toFloat)
    )

  // At constant acceleration, as the simulator carries them on.
  private def ownX: Double      = state.x + state.vx * sinceStep + state.ax * (sinceStep * sinceStep / 2)
  private def ownY: Double      = state.y + state.vy * sinceStep + state.ay * (sinceStep * sinceStep / 2)
  private def sinceStep: Double = (now - steppedTo) * 1e-9
