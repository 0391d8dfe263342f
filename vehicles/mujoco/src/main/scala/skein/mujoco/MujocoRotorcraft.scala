package skein.mujoco

import skein.units.Vector3
import skein.vehicle.*

/** One multirotor whose body is a MuJoCo model, controlled by AirSim's flight controller ([[MujocoControls]])
  * at each of the model's steps. One instance for each vehicle.
  */
final class MujocoRotorcraft private (
    model: MujocoModel,
    bodies: MujocoBodies,
    val cascade: Option[CascadeGains]
) extends Rotorcraft:

  private val controller =
    cascade.fold(FlightController(gains, stepS))(TunedFlightController(gains, _, stepS))

  def airframe: Airframe     = MujocoRotorcraft.looks
  def gains: ControllerGains = MujocoRotorcraft.airSimGains
  def stepS: Double          = model.stepS

  def step(state: QuadrotorState, setpoint: Setpoint, environment: Environment): Unit =
    bodies.begin(0, state, environment)
    bodies.step()
    bodies.end(0, state, setpoint, environment, controller)

  def tuned(cascade: CascadeGains): Rotorcraft = new MujocoRotorcraft(model, bodies, Some(cascade))

  def land(state: QuadrotorState, yawRad: Double): Unit = bodies.land(0, state, yawRad)

  def hover(state: QuadrotorState, goalNed: Vector3, yawRad: Double, environment: Environment): Unit =
    bodies.hover(0, state, goalNed, yawRad)

  def hoverSagM(downM: Double, environment: Environment): Double = bodies.hoverSagM(downM)

object MujocoRotorcraft:
  /** AirSim's airframe, for drawing: MuJoCo's shapes are not drawn. */
  private val looks       = Airframe()
  private val airSimGains = ControllerGains()

  def apply(model: MujocoModel): MujocoRotorcraft = new MujocoRotorcraft(model, MujocoBodies(model, 1), None)

  /** The kind of vehicle, for the built-in simulator. */
  def kind(model: MujocoModel): RotorcraftKind = RotorcraftKind(model.stepS, () => apply(model))
