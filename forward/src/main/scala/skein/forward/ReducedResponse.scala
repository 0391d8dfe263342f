package skein.forward

import skein.signal.Kinematics
import skein.vehicle.{ReducedFlight, ReducedModel, ReducedVehicleModel, VehicleModel}

/** Forward simulation by an identified [[skein.vehicle.ReducedModel]], exact between the times at which commands begin
  * to act.
  */
final case class ReducedResponse(model: ReducedModel) extends VelocityResponse:
  def create(): Vehicle = ReducedVehicle(model)

  override def predictor: VehicleModel[?] = ReducedVehicleModel(model)

private[skein] final class ReducedVehicle(model: ReducedModel) extends Vehicle:
  private val flight    = ReducedFlight(model)
  private val coming    = DeadTime(model.deadTimeS)
  private var now, down = 0.0

  def start(x: Double, y: Double, z: Double): Unit =
    flight.start(0, x, y, 0, 0)
    now = 0; down = z
    coming.clear()

  def command(vx: Double, vy: Double): Unit = coming.put(now, vx, vy)

  def advance(timeS: Double): Unit =
    coming.until(timeS)((atS, vx, vy) => flight.act(atS, vx, vy))
    flight.advance(timeS)
    now = timeS

  def x: Double  = flight.x
  def y: Double  = flight.y
  def vx: Double = flight.vx
  def vy: Double = flight.vy

  override def seen: Kinematics = level(down)
