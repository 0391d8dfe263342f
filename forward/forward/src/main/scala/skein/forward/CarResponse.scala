package skein.forward

import skein.policy.Action
import skein.vehicle.{ConstantVelocity, DrivenCar, VehicleModel}

/** A car with a driver, which may drive among vehicles of any other kind. It differs from
  * `skein.airsim.AirSimCar` in that the driver reacts at every step of the model, not only to a new command.
  * The vertical part of a velocity is ignored; hovering and landing brake.
  */
private[skein] final case class CarResponse(startHeadingRad: Double) extends VelocityResponse:
  def plant: DrivenCar  = DrivenCar(startHeadingRad = startHeadingRad)
  def create(): Vehicle = PlantVehicle(plant)

  override def regardsYaw: Boolean = false

  override def performs: Action => Boolean =
    case _: (Action.Velocity | Action.VelocityAt | Action.Along) | Action.Hover | Action.Land => true
    case _: (Action.Position | Action.Turn | Action.Attitude)                                 => false

  override def predictor: VehicleModel[?] = ConstantVelocity

  private[skein] override def predictorUnder(loop: VehicleModel[?]): VehicleModel[?] = predictor
