package skein.forecast

import skein.units.Instant
import skein.vehicle.Guidance

/** One command sent to a vehicle.
  *
  * @param answeredAt when the controller learned that it had arrived, on the controller's clock
  * @param actsAt on the simulator's clock, where a buffer beside the vehicle lets it act at a fixed moment
  *   ([[skein.port.PlanBuffer]]), however late it arrives; else it acts when it arrives
  */
final case class Commanded(
    sequence: Long,
    guidance: Guidance,
    sentAt: Instant,
    answeredAt: Option[Instant] = None,
    actsAt: Option[Instant] = None
)
