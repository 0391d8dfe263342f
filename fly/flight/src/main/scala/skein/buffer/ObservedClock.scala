package skein.buffer

import skein.signal.{ClockAlignment, Stamped}
import skein.units.*

/** The simulator's clock, estimated from readings. Pure.
  *
  * The offset is [[ClockAlignment]]'s; its uncertainty is at most half the round trip of the quickest
  * readings. The rate, for simulators whose clock does not run at the machine's rate, is measured over a
  * second. Between two readings the clock is assumed to run on, so that a stop, a jump or a start is noticed
  * within two readings.
  *
  * @param from the reading from which the rate is measured
  * @param rate simulated seconds per second of the machine's clock
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

  /** The simulator's time when the machine's clock reads `now`; None if no recent reading is known. */
  def shows(now: Instant): Option[Instant] =
    val age = now.since(alignment.receivedAt)
    Option.when(age <= MostAge)(
      if alignment.standsStill then alignment.validAt
      else shown + Span.ofNanos((age.toNanos * rate).toLong)
    )

  /** The machine's time at which the simulator's clock will show `simulated` or a little more; None while it
    * stands still.
    */
  def comesTo(simulated: Instant): Option[Instant] = Option.when(!alignment.standsStill && rate > 0):
    alignment.receivedAt + Span.ofNanos(math.ceil(simulated.since(shown).toNanos / rate).toLong + 1)

  /** The simulator's time when the newest reading was received. */
  private def shown: Instant = alignment.receivedAt - alignment.offset

private[buffer] object ObservedClock:
  /** Maximum age of the newest reading at which the clock counts as known: ten intervals of readings. */
  val MostAge: Span = Span.ofMillis(100)

  /** Shortest and longest time over which a rate is measured. */
  private val Shortest = Span.ofMillis(50)
  private val Longest  = Span.ofSeconds(1)

  /** Rates within this distance of 1 count as 1: a measurement over the shortest time may be off by as much.
    */
  private val Usual = 0.07

  def of(reading: Stamped[?]): ObservedClock = ObservedClock(ClockAlignment.of(reading), reading, rate = 1)

  private def middle(reading: Stamped[?]) = reading.sentAt + reading.roundTrip / 2
