package skein.measure

import skein.record.{EventKind, Recording}
import skein.signal.TimeAxis
import skein.units.Decimals.fixed
import skein.units.Span

/** Why a complete flight has no result: the basis of its measurement is invalid.
  *
  * @param what the fault, in two or three words
  * @param why the reason, in a line
  */
final case class NoResult(what: String, why: String)

object NoResult:

  /** The reason recorded in flight, or else shown on the readings' clock. */
  def of(recording: Recording): Option[NoResult] =
    val noted = recording.events.collectFirst:
      case event if named.contains(event.kind) => NoResult(named(event.kind), event.detail)
    noted.orElse(clock(recording).map(NoResult(named(EventKind.ClockBroken), _)))

  private val named =
    Map(EventKind.ClockBroken -> "clock broken", EventKind.VehicleTaken -> "vehicle taken")

  private def clock(recording: Recording): Option[String] =
    val fault =
      if recording.flight.isPaused then stepped(recording)
      else TimeAxis.fault(recording.readings.iterator.map(one => (one.vehicle, one.state)))
    fault.orElse(endless(recording))

  /** Positions over a time that is not the flight's: a curve over it would need too much memory. */
  private def endless(recording: Recording): Option[String] =
    val times =
      (recording.readings.iterator.map(_.state.validAt) ++ recording.truths.iterator.map(_.validAt))
        .map(_.toNanos.toDouble * 1e-9)
        .toVector
    val most = Longest.max(recording.flight.duration * 2).toSeconds
    Option.when(times.nonEmpty && times.max - times.min > most):
      s"the simulator's clock advanced by ${(times.max - times.min).fixed(0)} s in a flight of " +
        s"${recording.flight.duration.toSeconds.fixed(0)} s"

  private val Longest = Span.ofSeconds(24 * 3600)

  /** The fault of a stepped simulator's clock. A vehicle is read once in a step, or more often while the
    * simulator stands still.
    */
  private def stepped(recording: Recording): Option[String] =
    val period = recording.flight.period
    recording.readings.groupBy(_.vehicle).valuesIterator.flatMap { readings =>
      val times = readings.map(_.state.validAt)
      val steps = recording.decisions.count(_.vehicle == readings.head.vehicle)
      val leaps =
        for
          (before, now) <- times.zip(times.drop(1)) if now < before || now.since(before) > period
          fault         <- TimeAxis.steppedFault(Some(before), now, now, period)
        yield fault
      leaps.headOption.orElse(
        Option.when(steps > 2 && times.last.since(times.head) < period * (steps - 1) / 2)(
          s"the simulator's clock stood still: it advanced by ${times.last.since(times.head).toSeconds} s in " +
            s"${steps - 1} steps of ${period.toSeconds} s"
        )
      )
    }.nextOption()
