package skein.loop

import skein.flow.Steered
import skein.port.VehicleError

/** A command to one vehicle that was sent or has ended. */
final case class SteeringEvent(vehicle: Int, event: Steered[Decision, Either[VehicleError, Boolean]])
