package skein.measure

import skein.scenario.Scenario
import skein.units.Span

/** The paused flights with which others are compared, indexed once for all of them: there may be 100,000. */
final class Truth private (paused: Map[Truth.Kind, Vector[FlightSummary]]):
  import Truth.*

  private val ofClock =
    paused.flatMap((kind, flights) =>
      flights.groupBy(_.flight.clock).map((clock, same) => (kind, clock) -> same)
    )

  private val means        = paused.map((kind, flights) => kind -> mean(flights))
  private val meansOfClock = ofClock.map((kind, flights) => kind -> mean(flights))

  /** The paused flights with which a flight is compared: equal in scenario and settings, policies, period and
    * duration; those with the flight's own clock if there are any. None for a paused flight.
    */
  def of(flight: FlightSummary): Vector[FlightSummary] =
    found(flight, ofClock, paused).getOrElse(Vector.empty)

  /** A flight's headline ([[FlightSummary.headline]]) relative to the mean of its paused flights: 0.02 is 2 %
    * more. Absent for a paused flight itself, without one, and if the mean is 0.
    */
  def deviation(flight: FlightSummary): Option[Double] =
    for
      truth <- found(flight, meansOfClock, means) if truth != 0
      own   <- flight.headline
    yield own / truth - 1

object Truth:
  /** The settings that a flight shares with its paused flights: scenario, policy, period and duration. */
  private type Kind = (Option[Scenario], Option[String], Span, Span)

  def among(flights: Seq[FlightSummary]): Truth = Truth(
    flights.toVector.filter(one => one.flight.isPaused && one.headline.isDefined).groupBy(kind)
  )

  private def kind(flight: FlightSummary): Kind =
    (flight.scenario, flight.policy, flight.flight.period, flight.flight.duration)

  private def mean(flights: Vector[FlightSummary]): Double =
    Distribution.of(flights.flatMap(_.headline)).get.mean

  private def found[A](
      flight: FlightSummary,
      ofClock: Map[(Kind, String), A],
      ofAny: Map[Kind, A]
  ): Option[A] =
    if flight.flight.isPaused then None
    else
      val same = kind(flight)
      ofClock.get((same, flight.flight.clock)).orElse(ofAny.get(same))
