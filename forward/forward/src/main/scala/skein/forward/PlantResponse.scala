package skein.forward

import skein.policy.Action
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

private[skein] final class PlantVehicle[S](plant: Plant[S]) extends Vehicle:
  private val coming               = DeadTime(plant.deadTimeS)
  private val flight               = PlantFlight(plant)
  private var reading              = flight.reading
  private var nowS                 = 0.0
  private var startX, startY, down = 0.0
  private var isCommanded          = false

  def start(x: Double, y: Double, z: Double): Unit =
    startX = x; startY = y; down = z
    reading = plant.read(plant.initial)
    nowS = 0; isCommanded = false
    coming.clear()

  def act(action: Action): Unit = action.byVelocity match
    case Action.Velocity(velocity, _)         => coming.put(nowS, velocity.x, velocity.y)
    case Action.VelocityAt(north, east, _, _) => coming.put(nowS, north, east)
    case _                                    => coming.put(nowS, 0, 0)

  def advance(timeS: Double): Unit =
    coming.until(timeS): (atS, vx, vy, _, _) =>
      if isCommanded then flight.act(atS, vx, vy) else flight.start(atS, plant.initial, vx, vy)
      isCommanded = true
    if isCommanded then
      flight.advance(timeS)
      reading = flight.reading
    nowS = timeS

  def x: Double  = startX + reading.northM
  def y: Double  = startY + reading.eastM
  def z: Double  = down
  def vx: Double = reading.northMps
  def vy: Double = reading.eastMps

  override def seen: Kinematics = level(down)
