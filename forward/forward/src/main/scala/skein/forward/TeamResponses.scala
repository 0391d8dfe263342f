package skein.forward

import skein.vehicle.VehicleKind

private[skein] object TeamResponses:
  /** The response of each vehicle of a team; cars drive by their own, and are sensed as all others.
    *
    * @param model of all other vehicles
    */
  def of(agents: Vector[RolloutAgent], model: VelocityResponse): Vector[VelocityResponse] =
    for agent <- agents
    yield
      if agent.kind != VehicleKind.Car then model
      else
        val car = CarResponse(agent.startHeadingRad)
        model.sensors.fold(car)(SensedResponse(car, _))
