package skein.signal

import skein.units.*

/** Relates the clock of message headers to the receiver's clock, for messages that go in one direction only.
  * The fastest message so far is assumed to have been received when it was sent, so ages are times beyond the
  * fastest transmission. The clocks may drift. The relation starts again at a stamp that is earlier than
  * expected by more than [[FastestMessage.Restart]], as after a pause of a simulation, and at every message
  * that is faster than expected.
  *
  * @param offset upper bound of the receiver's clock minus the header's
  * @param at arrival time of the fastest message
  */
final case class FastestMessage(offset: Span, at: Instant):
  import FastestMessage.*

  def updated(validAt: Instant, receivedAt: Instant): FastestMessage =
    val one   = receivedAt.since(validAt)
    val drift = Span.ofNanos((receivedAt.since(at).max(Span.Zero).toNanos * ClockAlignment.MaxDrift).toLong)
    if one <= offset + drift || one > offset + Restart then FastestMessage(one, receivedAt) else this

  /** The earliest time at which the message's stamp may have been taken, on the receiver's clock. */
  def sentAt(validAt: Instant, receivedAt: Instant): Instant = (validAt + offset - Doubt).min(receivedAt)

object FastestMessage:
  /** Maximum time by which a later message may be faster than the fastest so far; a larger difference
    * contradicts the clocks' alignment.
    */
  val Doubt: Span = Span.ofMillis(5)

  /** Longer than the delay of any message; middleware stores about ten messages of a topic. */
  val Restart: Span = Span.ofSeconds(2)
