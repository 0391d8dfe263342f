package skein.forecast

import skein.units.Instant
import skein.vehicle.Guidance

/** One command sent to a vehicle.
  *
  * @param answeredAt when the controller learned that it had arrived, on the controller's clock
  */
final case class Commanded(
    sequence: Long,
    guidance: Guidance,
    sentAt: Instant,
    answeredAt: Option[Instant] = None
)
