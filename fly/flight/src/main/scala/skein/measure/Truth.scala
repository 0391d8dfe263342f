package skein.measure

import skein.scenario.Scenario
import skein.units.Span

/** The paused flights with which others are compared, indexed once for all of them: there may be 100,000. */
final class Truth private (paused: Map[Truth.Kind, Vector[FlightSummary]]):
  import Truth.*

  private val ofPlace =
    paused.flatMap((kind, flights) => flights.groupBy(place).map((at, same) => (kind, at) -> same))

  private val means        = paused.map((kind, flights) => kind -> mean(flights))
  private val meansOfPlace = ofPlace.map((kind, flights) => kind -> mean(flights))

  /** The paused flights with which a flight is compared: equal in scenario and settings, policies, period,
    * duration, plant, sensors, scene and knowledge; those with the flight's own clock and simulator if there
    * are any. None for a paused flight.
    */
  def of(flight: FlightSummary): Vector[FlightSummary] =
    found(flight, ofPlace, paused).getOrElse(Vector.empty)

  /** A flight's headline ([[FlightSummary.headline]]) relative to the mean of its paused flights: 0.02 is 2 %
    * more. Absent for a paused flight itself, without one, and if the mean is 0.
    */
  def deviation(flight: FlightSummary): Option[Double] =
    for
      truth <- found(flight, meansOfPlace, means) if truth != 0
      own   <- flight.headline
    yield (own - truth) / truth.abs

object Truth:
  /** The settings that a flight shares with its paused flights: scenario, policy, period, duration and the
    * options that change the truth.
    */
  private type Kind = (Option[Scenario], Option[String], Span, Span, Vector[(String, String)])

  private type Place = (clock: String, simulator: String)

  def among(flights: Seq[FlightSummary]): Truth = Truth(
    flights.toVector.filter(one => one.flight.isPaused && one.headline.isDefined).groupBy(kind)
  )

  private def kind(flight: FlightSummary): Kind =
    import flight.{options, policy, scenario}
    (scenario, policy, flight.flight.period, flight.flight.duration, FlightOptions.ofTruth(options))

  private def place(flight: FlightSummary): Place =
    (clock = flight.flight.clock, simulator = flight.flight.simulator.label)

  private def mean(flights: Vector[FlightSummary]): Double =
    Distribution.of(flights.flatMap(_.headline)).get.mean

  private def found[A](
      flight: FlightSummary,
      ofPlace: Map[(Kind, Place), A],
      ofAny: Map[Kind, A]
  ): Option[A] =
    if flight.flight.isPaused then None
    else
      val same = kind(flight)
      ofPlace.get((same, place(flight))).orElse(ofAny.get(same))
