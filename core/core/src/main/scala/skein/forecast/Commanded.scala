package skein.forecast

import skein.units.Instant
import skein.vehicle.Guidance

/** One command sent to a vehicle.
  *
  * @param answeredAt time at which the controller learned that the command had arrived, on the controller's
  *   clock
  * @param actsAt time at which a buffer on the vehicle's side of the link lets the command act
  *   ([[skein.port.PlanBuffer]]), on the simulator's clock; without a buffer the command acts when it arrives
  */
final case class Commanded(
    sequence: Long,
    guidance: Guidance,
    sentAt: Instant,
    answeredAt: Option[Instant] = None,
    actsAt: Option[Instant] = None
)
