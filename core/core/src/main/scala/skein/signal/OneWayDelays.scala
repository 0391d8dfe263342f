package skein.signal

import skein.units.*

/** How long messages take to the simulator and back, as means over the latest readings.
  *
  * `toSimulator` is a difference between two clocks: it contains the clocks' offset. That is what prediction
  * needs (a command sent at t acts when the simulator's clock shows t + toSimulator), and it does not depend
  * on the uncertainty of the offset. [[ClockAlignment]] estimates the offset.
  *
  * @param toSimulator mean of simulator's time of sampling minus controller's time of sending
  * @param fromSimulator mean of controller's time of receipt minus simulator's time of sampling
  */
final case class OneWayDelays private (toSimulator: Span, fromSimulator: Span, readings: Int):

  def roundTrip: Span = toSimulator + fromSimulator

  /** The simulator's time at which a message takes effect that was sent at this controller's time. */
  def expectedArrival(sentAt: Instant): Instant = sentAt + toSimulator

  /** The arrival time of a message whose answer was received. Its round trip says more than the means do: of
    * two independent, equally spread delays whose sum is known, each is its own mean plus half of the sum's
    * deviation.
    */
  def arrivalGiven(sentAt: Instant, answeredAt: Instant): Instant =
    sentAt + toSimulator + (answeredAt.since(sentAt) - roundTrip) / 2

  /** The means with one more reading: plain means of the first [[OneWayDelays.Memory]] readings, exponential
    * ones thereafter.
    */
  def updated(reading: Stamped[?]): OneWayDelays =
    val one    = OneWayDelays.of(reading)
    val weight = (readings + 1).min(OneWayDelays.Memory).toLong
    OneWayDelays(
      toSimulator + (one.toSimulator - toSimulator) / weight,
      fromSimulator + (one.fromSimulator - fromSimulator) / weight,
      (readings + 1).min(OneWayDelays.Memory)
    )

object OneWayDelays:

  /** Approximate number of readings behind the means: 1.6 s at 20 a second, so that a link that turns busy is
    * noticed soon.
    */
  val Memory = 32

  def of(reading: Stamped[?]): OneWayDelays =
    OneWayDelays(reading.validAt.since(reading.sentAt), reading.receivedAt.since(reading.validAt), 1)
