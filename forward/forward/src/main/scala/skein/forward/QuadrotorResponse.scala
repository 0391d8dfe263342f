package skein.forward

import skein.policy.{Action, ActionGuidance, OnWire}
import skein.port.Moves
import skein.units.{Quaternion, Vector3}
import skein.vehicle.{Environment, Guidance, Quadrotor, Rotorcraft, Setpoint}

/** AirSim's quadrotor as in the built-in simulator (`skein.simulator.SimulatedMultirotor`), with all actions.
  * Physics advances in whole steps, counted from the time at which the vehicle was placed at its start; a
  * command takes effect at the first step after its arrival. Commands are 32-bit floats, as on AirSim's wire;
  * [[SteppedVehicle]] defines the readings. A vehicle that turns in place or hovers holds its position at the
  * arrival of the command; in the built-in simulator it holds the position of up to 60 ms later.
  */
private[skein] final class QuadrotorResponse(val quadrotor: Quadrotor, val hoveredS: Double)
    extends VelocityResponse:
  def create(): Vehicle = QuadrotorVehicle(quadrotor, Nanos.of(hoveredS))

  override def handoverS: Double = Moves.Handover.toSeconds

  override def isSpatial: Boolean = true

private[skein] final class QuadrotorVehicle(quadrotor: Rotorcraft, hoveredNs: Long) extends SteppedVehicle:
  private val stepNs             = Nanos.of(quadrotor.stepS)
  private var guidance: Guidance = Setpoint.Disarmed
  private var setpoint: Setpoint = Setpoint.Disarmed
  private var renewedAt          = 0L

  // Since the vehicle was placed at its start, ns.
  private var now, steppedTo = 0L

  def start(x: Double, y: Double, z: Double): Unit =
    originX = x; originY = y
    val hold = Vector3(0, 0, z - quadrotor.hoverSagM(z))
    quadrotor.hover(state, hold, 0, Environment.Calm)
    state.place(Vector3(0, 0, z), Quaternion.Identity)
    fly(Setpoint.hold(hold))
    now = 0; steppedTo = 0
    advance(0)

  def act(action: Action): Unit =
    fly(OnWire.of(action) match
      case Action.Hover     => Setpoint.hold(state.positionNed)
      case Action.Turn(yaw) => ActionGuidance.turned(Setpoint.hold(state.positionNed), yaw, Vector3.Zero)
      case other            => ActionGuidance.of(other))

  private def fly(by: Guidance): Unit =
    guidance = by
    renewedAt = now
    setpoint = OnWire.of(by.setpoint(state.kinematics))

  def advance(timeS: Double): Unit =
    now = hoveredNs + Nanos.of(timeS)
    while steppedTo + stepNs <= now do
      for period <- guidance.period if steppedTo - renewedAt >= period.toNanos do
        renewedAt += period.toNanos
        setpoint = OnWire.of(guidance.setpoint(state.kinematics))
      quadrotor.step(state, setpoint, Environment.Calm)
      steppedTo += stepNs

  protected def sinceStepS: Double = (now - steppedTo) * 1e-9
