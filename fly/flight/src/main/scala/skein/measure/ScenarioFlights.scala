package skein.measure

import skein.scenario.{Result, Scenario}

/** Flights of one scenario with the same settings.
  *
  * @param withoutResult flights of it that have none
  */
final case class ScenarioFlights(
    scenario: Scenario,
    flights: Vector[ScenarioFlights.Flown],
    withoutResult: Vector[FlightSummary]
):

  /** The paused flight that figures show beside the others. What each is measured against, [[Truth]] says. */
  val truth: Option[ScenarioFlights.Flown] = flights.find(_.summary.flight.isPaused)

  /** The first measure against that of the flight's [[Truth]]. */
  def deviation(flight: ScenarioFlights.Flown): Option[Double] = truths.deviation(flight.summary)

  private lazy val truths = Truth.among(flights.map(_.summary))

  /** Root mean square distance from the places of its [[Truth]] at the same time, m; absent for the truth
    * itself, and where the machine was too busy.
    */
  def offTruthM(flight: ScenarioFlights.Flown): Option[Double] =
    truths.of(flight.summary).headOption.filter(_ => flight.summary.starved.isEmpty).flatMap(_.result).map(
      truth =>
        flight.result.tracks.rmsFrom(truth.tracks, inSpace = !scenario.isPlanar)
    )

object ScenarioFlights:

  final case class Flown(summary: FlightSummary, result: Result)

  /** By scenario, in the order of the flights; without flights of scenarios that are not known. */
  def of(flights: Vector[FlightSummary]): Vector[ScenarioFlights] =
    val flown = flights.flatMap(summary => summary.result.map(Flown(summary, _)))
    val none  = flights.filter(_.noResult.isDefined)
    (flown.map(_.result.scenario) ++ none.flatMap(_.scenario)).distinct.map(scenario =>
      ScenarioFlights(
        scenario,
        flown.filter(_.result.scenario == scenario),
        none.filter(_.scenario.contains(scenario))
      )
    )
