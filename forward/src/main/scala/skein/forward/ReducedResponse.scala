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
  import ReducedVehicle.Pending
  private val flight           = ReducedFlight(model)
  private var now, down        = 0.0
  private val at, atVx, atVy   = Array.ofDim[Double](Pending)
  private var first, afterLast = 0

  def start(x: Double, y: Double, z: Double): Unit =
    flight.start(0, x, y, 0, 0)
    now = 0; down = z; first = 0; afterLast = 0

  def command(vx: Double, vy: Double): Unit =
    if afterLast - first == Pending then
      throw IllegalStateException(s"more than $Pending commands within the dead time of ${model.deadTimeS} s")
    val slot = afterLast % Pending
    at(slot) = now + model.deadTimeS; atVx(slot) = vx; atVy(slot) = vy
    afterLast += 1

  def advance(timeS: Double): Unit =
    while first < afterLast && at(first % Pending) <= timeS do
      val slot = first % Pending
      flight.act(at(slot), atVx(slot), atVy(slot))
      first += 1
    flight.advance(timeS)
    now = timeS

  def x: Double  = flight.x
  def y: Double  = flight.y
  def vx: Double = flight.vx
  def vy: Double = flight.vy

  override def seen: Kinematics = level(down)

private[skein] object ReducedVehicle:
  private val Pending = 64
