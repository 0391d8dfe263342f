package skein.measure

/** The prediction errors of all flights of one loop over one link in one scenario.
  *
  * @param scenario empty if all flights that are shown are of one
  */
final case class PredictionGroup(
    name: String,
    link: String,
    own: PredictionErrors,
    others: PredictionErrors,
    scenario: String = ""
)

object PredictionGroup:

  def of(flights: Seq[FlightSummary]): Vector[PredictionGroup] =
    val predicted               = flights.toVector.filter(_.predictions.nonEmpty)
    val scenarioOf              = ScenarioNames.among(flights)
    def key(one: FlightSummary) = (one.name, one.flight.link, scenarioOf(one))
    for
      (name, link, scenario) <- predicted.map(key).distinct
      group  = predicted.filter(one => key(one) == (name, link, scenario))
      errors = group.flatMap(_.predictions)
    yield PredictionGroup(
      name,
      link,
      errors.map(_.own).reduce(_ ++ _),
      errors.map(_.others).reduce(_ ++ _),
      scenario
    )
