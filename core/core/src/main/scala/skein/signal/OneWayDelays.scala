package skein.signal

import skein.units.*

/** Mean delays of messages to the simulator and back, over the latest readings.
  *
  * `toSimulator` is a difference between two clocks, and thus contains their offset. That is what predictions
  * need: a command sent at t acts when the simulator's clock shows t + toSimulator, however uncertain the
  * offset is. [[ClockAlignment]] estimates the offset.
  *
  * @param toSimulator mean of the simulator's time of sampling minus the controller's time of sending
  * @param fromSimulator mean of the controller's time of receipt minus the simulator's time of sampling
  */
final case class OneWayDelays private (toSimulator: Span, fromSimulator: Span, readings: Int):

  def roundTrip: Span = toSimulator + fromSimulator

  /** The simulator's time at which a message arrives that was sent at this controller's time. */
  def expectedArrival(sentAt: Instant): Instant = sentAt + toSimulator

  /** The expected arrival time of a message whose answer was received. Its round trip contains more
    * information than the means: given the sum of two independent delays whose distributions differ only in
    * their means, the expected value of each is its mean plus half of the sum's deviation from its mean.
    */
  def arrivalGiven(sentAt: Instant, answeredAt: Instant): Instant =
    sentAt + toSimulator + (answeredAt.since(sentAt) - roundTrip) / 2

  /** The means with one more reading: arithmetic means of the first [[OneWayDelays.Memory]] readings,
    * exponential means after that.
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

  /** Approximate number of readings in the means: 1.6 s at 20 readings per second, so that a link that
    * becomes busy is noticed soon.
    */
  val Memory = 32

  def of(reading: Stamped[?]): OneWayDelays =
    OneWayDelays(reading.validAt.since(reading.sentAt), reading.receivedAt.since(reading.validAt), 1)
