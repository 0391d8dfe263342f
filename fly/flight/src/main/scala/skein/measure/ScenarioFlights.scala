package skein.measure

import skein.scenario.{Result, Scenario}

/** Flights of one scenario with equal settings.
  *
  * @param withoutResult its flights without a result
  * @param name its name, with settings if flights with others are shown ([[ScenarioNames]])
  */
final case class ScenarioFlights(
    scenario: Scenario,
    flights: Vector[ScenarioFlights.Flown],
    withoutResult: Vector[FlightSummary],
    name: String
):

  /** The paused flight that figures show with the other flights. [[Truth]] decides with which flight each is
    * compared.
    */
  val truth: Option[ScenarioFlights.Flown] = flights.find(_.summary.flight.isPaused)

  /** The deviation of the first measure from that of the flight's [[Truth]]. */
  def deviation(flight: ScenarioFlights.Flown): Option[Double] = truths.deviation(flight.summary)

  private lazy val truths = Truth.among(flights.map(_.summary))

  /** Root mean square distance from the positions of its paused flight ([[Truth]]) at equal times, m; absent
    * for the paused flight itself, and if the machine was too busy.
    */
  def offTruthM(flight: ScenarioFlights.Flown): Option[Double] =
    truths.of(flight.summary).headOption.filter(_ => flight.summary.starved.isEmpty).flatMap(_.result).map(
      truth =>
        flight.result.tracks.rmsFrom(truth.tracks, inSpace = !scenario.isPlanar)
    )

object ScenarioFlights:

  final case class Flown(summary: FlightSummary, result: Result)

  /** Groups flights by scenario, in their order; omits those of unknown scenarios. */
  def of(flights: Vector[FlightSummary]): Vector[ScenarioFlights] =
    val flown = flights.flatMap(summary => summary.result.map(Flown(summary, _)))
    val none  = flights.filter(_.noResult.isDefined)
    val all   = (flown.map(_.result.scenario) ++ none.flatMap(_.scenario)).distinct
    val names = ScenarioNames.of(all)
    all.map(scenario =>
      ScenarioFlights(
        scenario,
        flown.filter(_.result.scenario == scenario),
        none.filter(_.scenario.contains(scenario)),
        names(scenario)
      )
    )
