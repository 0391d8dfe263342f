package skein.measure

import skein.scenario.{Result, Scenario}

/** Flights of one scenario with the same settings; at least one. */
final case class ScenarioFlights(flights: Vector[ScenarioFlights.Flown]):

  def scenario: Scenario = flights.head.result.scenario

  /** The paused flight that figures show beside the others. What each is measured against, [[Truth]] says. */
  val truth: Option[ScenarioFlights.Flown] = flights.find(_.summary.flight.isPaused)

  /** The first measure against that of the flight's [[Truth]]. */
  def deviation(flight: ScenarioFlights.Flown): Option[Double] = truths.deviation(flight.summary)

  private lazy val truths = Truth.among(flights.map(_.summary))

  /** Root mean square distance from the places of its [[Truth]] at the same time, m; absent for the truth
    * itself.
    */
  def offTruthM(flight: ScenarioFlights.Flown): Option[Double] =
    truths.of(flight.summary).headOption.flatMap(_.result).map(truth =>
      flight.result.tracks.rmsFrom(truth.tracks, inSpace = !scenario.isPlanar)
    )

object ScenarioFlights:

  final case class Flown(summary: FlightSummary, result: Result)

  /** By scenario, in the order of the flights; without flights of scenarios that are not known. */
  def of(flights: Vector[FlightSummary]): Vector[ScenarioFlights] =
    val flown = flights.flatMap(summary => summary.result.map(Flown(summary, _)))
    flown.map(_.result.scenario).distinct.map(scenario =>
      ScenarioFlights(flown.filter(_.result.scenario == scenario))
    )
