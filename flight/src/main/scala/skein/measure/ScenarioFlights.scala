package skein.measure

import skein.scenario.{Result, Scenario}

/** Flights of one scenario with the same settings; at least one. */
final case class ScenarioFlights(flights: Vector[ScenarioFlights.Flown]):

  def scenario: Scenario = flights.head.result.scenario

  /** The flight that the others are measured against. */
  val truth: Option[ScenarioFlights.Flown] = flights.find(_.summary.flight.isPaused)

  /** The first measure against the truth's, as a share of the truth's; absent for the truth itself, and where
    * that came to 0.
    */
  def deviation(flight: ScenarioFlights.Flown): Option[Double] =
    for
      truth <- truth if truth != flight
      from  <- truth.summary.headline if from != 0
      own   <- flight.summary.headline
    yield own / from - 1

  /** Root mean square distance from the truth's places at the same time, m; absent for the truth itself. */
  def offTruthM(flight: ScenarioFlights.Flown): Option[Double] =
    truth.filter(_ != flight).map(truth =>
      flight.result.tracks.rmsFrom(truth.result.tracks, inSpace = !scenario.isPlanar)
    )

object ScenarioFlights:

  final case class Flown(summary: FlightSummary, result: Result)

  /** By scenario, in the order of the flights; without flights of scenarios that are not known. */
  def of(flights: Vector[FlightSummary]): Vector[ScenarioFlights] =
    val flown = flights.flatMap(summary => summary.result.map(Flown(summary, _)))
    flown.map(_.result.scenario).distinct.map(scenario =>
      ScenarioFlights(flown.filter(_.result.scenario == scenario))
    )
