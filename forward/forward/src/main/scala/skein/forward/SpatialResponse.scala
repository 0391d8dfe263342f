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

private final class SpatialVehicle[S](plant: SpatialPlant[S]) extends DelayedVehicle(plant.deadTimeS):
  private val flight  = SpatialFlight(plant)
  private var reading = flight.reading

  protected def rest(downM: Double): Unit =
    flight.rest(downM)
    reading = flight.reading

  protected def take(command: DelayedVehicle.Coming, isFirst: Boolean): Unit =
    import command.*
    if !isFirst then flight.advance(atS)
    flight.act(atS, northMps, eastMps, third, holds)

  protected def fly(timeS: Double): Unit =
    flight.advance(timeS)
    reading = flight.reading

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
