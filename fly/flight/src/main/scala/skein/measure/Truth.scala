package skein.measure

import skein.scenario.Scenario
import skein.units.Span

/** The paused flights that others are held against, sought once for all of them: there may be 100,000. */
final class Truth private (paused: Map[Truth.Kind, Vector[FlightSummary]]):
  import Truth.*

  private val ofClock =
    paused.flatMap((kind, flights) =>
      flights.groupBy(_.flight.clock).map((clock, same) => (kind, clock) -> same)
    )

  private val means        = paused.map((kind, flights) => kind -> mean(flights))
  private val meansOfClock = ofClock.map((kind, flights) => kind -> mean(flights))

  /** Those of the same scenario and settings, policies, period and duration; of the flight's own clock where
    * there are some. None for a paused flight.
    */
  def of(flight: FlightSummary): Vector[FlightSummary] =
    found(flight, ofClock, paused).getOrElse(Vector.empty)

  /** What a flight comes to ([[FlightSummary.headline]]) against the mean of its truths, as a share of that:
    * 0.02 is 2 % more. Absent for a truth itself, without one, and where that came to 0.
    */
  def deviation(flight: FlightSummary): Option[Double] =
    for
      truth <- found(flight, meansOfClock, means) if truth != 0
      own   <- flight.headline
    yield own / truth - 1

object Truth:
  /** Scenario with its settings, policy, period and duration. */
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
