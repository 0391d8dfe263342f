package skein.mujoco

import skein.forward.{QuadrotorVehicle, SteppedResponse, SteppedVehicles, Vehicle}
import skein.port.Moves
import skein.units.{Quaternion, Vector3}
import skein.vehicle.*

/** A model's multirotor in forward simulation, controlled through AirSim's API as in the built-in simulator;
  * many at a time by MuJoCo's batch, with identical bits.
  */
final class MujocoResponse(model: MujocoModel) extends SteppedResponse:
  def stepS: Double    = model.stepS
  def hoveredS: Double = 0

  def create(): Vehicle = QuadrotorVehicle(MujocoRotorcraft(model), 0)

  def together(vehicles: Int): SteppedVehicles = MujocoVehicles(model, vehicles)

  override def handoverS: Double = Moves.Handover.toSeconds

/** A batch of multirotors of one model, each with its flight controller's state. */
private[mujoco] final class MujocoVehicles(model: MujocoModel, vehicles: Int) extends SteppedVehicles:
  private val bodies     = MujocoBodies(model, vehicles)
  private val controller = FlightController(ControllerGains(), model.stepS)
  private val states     = Array.fill(vehicles)(QuadrotorState())
  private val setpoints  = Array.fill(vehicles)(Setpoint.Disarmed)
  private var used       = vehicles

  def use(vehicles: Int): Unit = used = vehicles

  def hover(place: Int, downM: Double): Unit =
    val hold = Vector3(0, 0, downM - bodies.hoverSagM(downM))
    bodies.hover(place, states(place), hold, 0)
    states(place).place(Vector3(0, 0, downM), Quaternion.Identity)
    setpoints(place) = Setpoint.hold(hold)

  def command(place: Int, northMps: Float, eastMps: Float, downM: Float): Unit =
    setpoints(place) = Setpoint.velocityZ(northMps, eastMps, downM)

  def step(): Unit =
    var place = 0
    while place < used do
      bodies.begin(place, states(place), Environment.Calm)
      place += 1
    bodies.step()
    place = 0
    while place < used do
      bodies.end(place, states(place), setpoints(place), Environment.Calm, controller)
      place += 1

  def read(place: Int, into: QuadrotorState): Unit = into.copyFrom(states(place))
