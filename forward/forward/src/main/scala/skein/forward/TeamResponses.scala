package skein.forward

import skein.vehicle.VehicleKind

private[skein] object TeamResponses:
  /** The response of each vehicle of a team; cars drive by their own.
    *
    * @param model of all other vehicles
    */
  def of(agents: Vector[RolloutAgent], model: VelocityResponse): Vector[VelocityResponse] =
    for agent <- agents
    yield if agent.kind == VehicleKind.Car then CarResponse(agent.startHeadingRad) else model
