package skein.forecast

import skein.units.Instant
import skein.vehicle.Guidance

/** One command sent to a vehicle.
  *
  * @param answeredAt when it was known to have arrived, on the controller's clock
  */
final case class Commanded(
    sequence: Long,
    guidance: Guidance,
    sentAt: Instant,
    answeredAt: Option[Instant] = None
)
