package skein.buffer

import skein.signal.{ClockAlignment, Stamped}
import skein.units.*

/** The simulator's clock, as readings show it. Pure.
  *
  * The offset is [[ClockAlignment]]'s, whose uncertainty is half the round trip of the quickest readings, or
  * less. The rate, for simulators whose clock is not the machine's, is measured over a second. Between two
  * readings the clock is taken to go on. So one that is stopped, set or started is followed within two
  * readings.
  *
  * @param from the reading from which the rate is measured
  * @param rate simulated seconds in a second
  */
private[buffer] final case class ObservedClock private (
    alignment: ClockAlignment,
    from: Stamped[?],
    rate: Double
):
  import ObservedClock.*

  def updated(reading: Stamped[?]): ObservedClock =
    val next  = alignment.updated(reading)
    val apart = middle(reading).since(middle(from))
    val went  = reading.validAt.since(from.validAt)
    val isGap = reading.sentAt.since(alignment.receivedAt) > MostAge
    if isGap || next.standsStill || alignment.standsStill || went <= Span.Zero then
      ObservedClock(next, reading, rate)
    else if apart < Shortest then copy(alignment = next)
    else
      val measured = went.toNanos.toDouble / apart.toNanos
      val usual    = if math.abs(measured - 1) < Usual then 1.0 else measured
      ObservedClock(next, if apart > Longest then reading else from, usual)

  /** What the clock shows at `now`, on the machine's clock; None if no reading is new enough. */
  def shows(now: Instant): Option[Instant] =
    val age = now.since(alignment.receivedAt)
    Option.when(age <= MostAge)(
      if alignment.standsStill then alignment.validAt
      else shown + Span.ofNanos((age.toNanos * rate).toLong)
    )

  /** When the clock will show this or a little more, on the machine's clock; None while it stands still. */
  def comesTo(simulated: Instant): Option[Instant] = Option.when(!alignment.standsStill && rate > 0):
    alignment.receivedAt + Span.ofNanos(math.ceil(simulated.since(shown).toNanos / rate).toLong + 1)

  /** What it showed when the newest reading was received. */
  private def shown: Instant = alignment.receivedAt - alignment.offset

private[buffer] object ObservedClock:
  /** Age of the newest reading up to which the clock counts as known: ten periods of readings. */
  val MostAge: Span = Span.ofMillis(100)

  /** Stretch over which a rate is measured at least, and at most. */
  private val Shortest = Span.ofMillis(50)
  private val Longest  = Span.ofSeconds(1)

  /** A rate this near to 1 is 1: what is measured over the shortest stretch may be off by as much. */
  private val Usual = 0.07

  def of(reading: Stamped[?]): ObservedClock = ObservedClock(ClockAlignment.of(reading), reading, rate = 1)

  private def middle(reading: Stamped[?]) = reading.sentAt + reading.roundTrip / 2
