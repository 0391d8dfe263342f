package skein.measure

/** Flights of one scenario of teams. */
final case class TeamFlights(flights: Vector[TeamFlights.Flown]):

  def scenario: String = flights.head.result.scenario.name

  /** The flight that the others are measured against. */
  val truth: Option[TeamFlights.Flown] = flights.find(_.summary.flight.isPaused)

  /** The first measure against the truth's, as a share of the truth's; absent for the truth itself. */
  def deviation(flight: TeamFlights.Flown): Option[Double] =
    for
      truth <- truth if truth != flight
      from  <- truth.result.measures.head.value
      own   <- flight.result.measures.head.value
    yield own / from - 1

  /** Root mean square distance from the truth's places at the same time, m; absent for the truth itself. */
  def offTruthM(flight: TeamFlights.Flown): Option[Double] =
    truth.filter(_ != flight).map(truth => flight.result.track.rmsFrom(truth.result.track))

object TeamFlights:

  final case class Flown(summary: FlightSummary, result: TeamResult)

  /** Those flights that are teams', by scenario, in the order of the flights. */
  def of(flights: Vector[FlightSummary]): Vector[TeamFlights] =
    val flown = flights.flatMap(summary => summary.team.map(Flown(summary, _)))
    flown.map(_.result.scenario).distinct.map(scenario =>
      TeamFlights(flown.filter(_.result.scenario == scenario))
    )
