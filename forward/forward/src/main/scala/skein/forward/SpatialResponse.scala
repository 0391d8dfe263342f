package skein.forward

import skein.policy.Action
import skein.signal.Kinematics
import skein.units.{Quaternion, Vector3}
import skein.vehicle.{
  ConstantVelocity,
  ObservedSpatialPlant,
  SpatialFlight,
  SpatialModel,
  SpatialPlant,
  VehicleModel
}

/** Vehicles that move according to a [[skein.vehicle.SpatialPlant]]. They perform velocities, with or without
  * an altitude. Yaws are ignored; to hover or to turn in place becomes a command to stand still.
  *
  * @param model what `predictive` takes them for, if that is not the plant itself
  */
final case class SpatialResponse(plant: SpatialPlant[?], model: Option[VehicleModel[?]] = None)
    extends VelocityResponse:
  require(plant.stepS > 0, s"a plant's step must be positive, got ${plant.stepS} s")
  require(plant.deadTimeS >= 0, s"a plant's dead time must not be negative, got ${plant.deadTimeS} s")

  def create(): Vehicle = SpatialVehicle(plant)

  override def isSpatial: Boolean = true

  override def regardsYaw: Boolean = false

  override def predictor: VehicleModel[?] = model.getOrElse:
    plant match
      case observed: ObservedSpatialPlant[?] => SpatialModel(observed)
      case _                                 => ConstantVelocity

  override def performs: Action => Boolean =
    case _: (Action.Velocity | Action.VelocityAt | Action.Along | Action.Turn) | Action.Hover => true
    case _: (Action.Position | Action.Attitude) | Action.Land                                 => false

private final class SpatialVehicle[S](plant: SpatialPlant[S]) extends Vehicle:
  private val coming         = DeadTime(plant.deadTimeS)
  private val flight         = SpatialFlight(plant)
  private var startX, startY = 0.0
  private var nowS           = 0.0
  private var isCommanded    = false
  private var reading        = flight.reading

  def start(x: Double, y: Double, z: Double): Unit =
    startX = x; startY = y
    flight.rest(z)
    reading = flight.reading
    nowS = 0; isCommanded = false
    coming.clear()

  def act(action: Action): Unit = action.byVelocity match
    case Action.Velocity(velocity, _)            => coming.put(nowS, velocity.x, velocity.y, velocity.z, 0)
    case Action.VelocityAt(north, east, down, _) => coming.put(nowS, north, east, down.value, 1)
    case _                                       => coming.put(nowS, 0, 0, 0, 0)

  def advance(timeS: Double): Unit =
    coming.until(timeS): (atS, vx, vy, third, holds) =>
      if isCommanded then flight.advance(atS)
      flight.act(atS, vx, vy, third, holds)
      isCommanded = true
    if isCommanded then
      flight.advance(timeS)
      reading = flight.reading
    nowS = timeS

  def x: Double  = startX + reading.northM
  def y: Double  = startY + reading.eastM
  def z: Double  = reading.downM
  def vx: Double = reading.northMps
  def vy: Double = reading.eastMps

  override def seen: Kinematics = Kinematics(
    Vector3(x, y, z),
    Vector3(vx, vy, reading.downMps),
    Quaternion.Identity,
    Vector3.Zero
  )
