package skein.loop

import skein.flow.Steered
import skein.port.VehicleError

/** The event that a command to one vehicle was sent or has ended. */
final case class SteeringEvent(vehicle: Int, event: Steered[Decision, Either[VehicleError, Boolean]])
