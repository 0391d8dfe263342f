package skein.offboard

import skein.signal.{ClockAlignment, Stamped}
import skein.units.*

/** A vehicle's clock against the controller's, by TIMESYNC.
  *
  * @param latestLeg of the newest exchange: the vehicle's time of its answer minus the controller's time of
  *   the question. It contains the clocks' offset
  * @param exchanges so far
  */
final case class VehicleClock(alignment: ClockAlignment, latestLeg: Span, exchanges: Int = 1):

  def answered(sentAt: Instant, answeredAt: Instant, receivedAt: Instant): VehicleClock =
    VehicleClock(
      alignment.updated(Stamped((), answeredAt, sentAt, receivedAt)),
      answeredAt.since(sentAt),
      exchanges + 1
    )

  /** What was sampled by the vehicle's clock and came unasked, as if it had been asked for as long before as
    * the newest TIMESYNC took to the vehicle. So the request cannot have left later than the sample was
    * taken, and its way is of the link's true distribution.
    *
    * @param shift of the vehicle's clock to the flight's
    * @param doubt of that shift
    */
  def stamped[A](value: A, sampledAt: Instant, receivedAt: Instant, shift: Span, doubt: Span): Stamped[A] =
    Stamped(value, sampledAt + shift, (sampledAt - latestLeg - doubt).min(receivedAt), receivedAt)

  /** By how much this clock's times differ from another's, and how uncertain that is. Zero and certain where
    * the two may be one: so are those of vehicles of one simulator.
    */
  def shiftTo(other: VehicleClock): (shift: Span, doubt: Span) =
    val apart = alignment.offset - other.alignment.offset
    val doubt = alignment.uncertainty + other.alignment.uncertainty
    if apart <= doubt && Span.Zero - apart <= doubt then (shift = Span.Zero, doubt = Span.Zero)
    else (shift = apart, doubt = doubt)

object VehicleClock:
  def of(sentAt: Instant, answeredAt: Instant, receivedAt: Instant): VehicleClock =
    VehicleClock(ClockAlignment.of(Stamped((), answeredAt, sentAt, receivedAt)), answeredAt.since(sentAt))
