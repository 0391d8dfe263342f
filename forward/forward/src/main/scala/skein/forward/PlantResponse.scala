package skein.forward

import skein.signal.Kinematics
import skein.vehicle.{ConstantVelocity, ObservedPlant, Plant, PlantFlight, PlantModel, VehicleModel}

/** Vehicles that move according to a [[skein.vehicle.Plant]]. Commands may take effect between steps; the
  * simulation is exact if the plant's step is. If the plant is a [[skein.vehicle.ObservedPlant]], the loop
  * `predictive` predicts by it, else by constant velocity.
  */
final case class PlantResponse(plant: Plant[?]) extends VelocityResponse:
  require(plant.stepS > 0, s"a plant's step must be positive, got ${plant.stepS} s")
  require(plant.deadTimeS >= 0, s"a plant's dead time must not be negative, got ${plant.deadTimeS} s")

  def create(): Vehicle = PlantVehicle(plant)

  override def regardsYaw: Boolean = false

  override def predictor: VehicleModel[?] = plant match
    case observed: ObservedPlant[?] => PlantModel(observed)
    case _                          => ConstantVelocity

private[skein] final class PlantVehicle[S](plant: Plant[S]) extends DelayedVehicle(plant.deadTimeS):
  private val flight  = PlantFlight(plant)
  private var reading = flight.reading
  private var down    = 0.0

  protected def rest(downM: Double): Unit =
    down = downM
    reading = plant.read(plant.initial)

  protected def take(command: DelayedVehicle.Coming, isFirst: Boolean): Unit =
    import command.{atS, eastMps, northMps}
    if isFirst then flight.start(atS, plant.initial, northMps, eastMps)
    else flight.act(atS, northMps, eastMps)

  protected def fly(timeS: Double): Unit =
    flight.advance(timeS)
    reading = flight.reading

  def x: Double  = startX + reading.northM
  def y: Double  = startY + reading.eastM
  def z: Double  = down
  def vx: Double = reading.northMps
  def vy: Double = reading.eastMps

  override def seen: Kinematics = level(down)
