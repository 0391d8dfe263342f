package skein.forward

import skein.vehicle.{ReducedModel, PlantModel, VehicleModel}

/** Forward simulation by an identified [[skein.vehicle.ReducedModel]], exact between the times at which
  * commands begin to act.
  */
final case class ReducedResponse(model: ReducedModel) extends VelocityResponse:
  def create(): Vehicle = PlantVehicle(model)

  override def predictor: VehicleModel[?] = PlantModel(model)
