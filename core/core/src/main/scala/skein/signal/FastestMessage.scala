package skein.signal

import skein.units.*

/** Relates the clock of message headers to the receiver's where nothing goes there and back: the fastest
  * message so far counts as sent and received at one instant. Ages are then those beyond the fastest
  * message's way. Drift of the clocks is allowed for, and a stamp that is later than expected by more than
  * [[FastestMessage.Restart]], as after a pause of a simulation, or any earlier one, begins anew.
  *
  * @param offset the receiver's clock minus the header's, at most
  * @param at when the fastest message was received
  */
final case class FastestMessage(offset: Span, at: Instant):
  import FastestMessage.*

  def updated(validAt: Instant, receivedAt: Instant): FastestMessage =
    val one   = receivedAt.since(validAt)
    val drift = Span.ofNanos((receivedAt.since(at).max(Span.Zero).toNanos * ClockAlignment.MaxDrift).toLong)
    if one <= offset + drift || one > offset + Restart then FastestMessage(one, receivedAt) else this

  /** The earliest time, by the receiver's clock, at which the message's stamp can have been taken. */
  def sentAt(validAt: Instant, receivedAt: Instant): Instant = (validAt + offset - Doubt).min(receivedAt)

object FastestMessage:
  /** How much faster than the fastest so far a later message may be: it would contradict the clocks'
    * alignment.
    */
  val Doubt: Span = Span.ofMillis(5)

  /** No message is delayed for so long; middleware keeps some ten of a topic. */
  val Restart: Span = Span.ofSeconds(2)
