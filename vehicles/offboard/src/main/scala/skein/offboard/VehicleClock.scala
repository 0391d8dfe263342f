package skein.offboard

import skein.signal.{ClockAlignment, Stamped}
import skein.units.*

/** A vehicle's clock relative to the controller's clock, measured by TIMESYNC.
  *
  * @param latestLeg leg of the newest exchange: the vehicle's time of its answer minus the controller's time
  *   of the request. It contains the clocks' offset
  * @param exchanges number of exchanges so far
  */
final case class VehicleClock(alignment: ClockAlignment, latestLeg: Span, exchanges: Int = 1):

  def answered(sentAt: Instant, answeredAt: Instant, receivedAt: Instant): VehicleClock =
    VehicleClock(
      alignment.updated(Stamped((), answeredAt, sentAt, receivedAt)),
      answeredAt.since(sentAt),
      exchanges + 1
    )

  /** Stamps an unrequested sample as if it had been requested one uplink delay of the newest TIMESYNC before
    * it was taken. So the request time is never later than the sample, and its delay has the link's true
    * distribution.
    *
    * @param shift the flight's clock minus the vehicle's
    * @param doubt uncertainty of that shift
    */
  def stamped[A](value: A, sampledAt: Instant, receivedAt: Instant, shift: Span, doubt: Span): Stamped[A] =
    Stamped(value, sampledAt + shift, (sampledAt - latestLeg - doubt).min(receivedAt), receivedAt)

  /** The shift from this clock's times to those of another clock, with its uncertainty. Both are zero if the
    * two may be one clock, as for vehicles of one simulator.
    */
  def shiftTo(other: VehicleClock): (shift: Span, doubt: Span) =
    val apart = alignment.offset - other.alignment.offset
    val doubt = alignment.uncertainty + other.alignment.uncertainty
    if apart <= doubt && Span.Zero - apart <= doubt then (shift = Span.Zero, doubt = Span.Zero)
    else (shift = apart, doubt = doubt)

object VehicleClock:
  def of(sentAt: Instant, answeredAt: Instant, receivedAt: Instant): VehicleClock =
    VehicleClock(ClockAlignment.of(Stamped((), answeredAt, sentAt, receivedAt)), answeredAt.since(sentAt))
