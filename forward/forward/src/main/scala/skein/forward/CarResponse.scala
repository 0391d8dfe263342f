package skein.forward

import skein.policy.Action
import skein.vehicle.{ConstantVelocity, DrivenCar, VehicleModel}

/** A car with its driver, beside vehicles of any other response: `skein.airsim.AirSimCar` with a driver who
  * looks at every step of the model, and not only when a command arrives. A velocity's vertical part is
  * ignored; hovering and landing brake.
  */
private[skein] final class CarResponse(startHeadingRad: Double) extends VelocityResponse:
  def create(): Vehicle = PlantVehicle(DrivenCar(startHeadingRad = startHeadingRad))

  override def regardsYaw: Boolean = false

  override def performs: Action => Boolean =
    case _: (Action.Velocity | Action.VelocityAt | Action.Along) | Action.Hover | Action.Land => true
    case _: (Action.Position | Action.Turn | Action.Attitude)                                 => false

  override def predictor: VehicleModel[?] = ConstantVelocity
