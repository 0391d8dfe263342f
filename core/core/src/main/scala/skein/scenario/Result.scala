package skein.scenario

/** The result of a flight.
  *
  * @param measured all measures; flights are compared by the first
  * @param violations the violations of all limits, in the order of their times
  */
final case class Result(
    scenario: Scenario,
    tracks: Tracks,
    measured: Vector[Measured],
    curves: Vector[(Series, Curve)],
    violations: Vector[Violation]
):
  /** The value of a measure, by its name; None if the flight has none. */
  def value(measure: String): Option[Double] =
    measured
      .find(_.measure.name == measure)
      .getOrElse(throw IllegalArgumentException(
        s"no measure '$measure'; there are: ${measured.map(_.measure.name).mkString(", ")}"
      ))
      .value

object Result:
  /** Evaluates a flight by its scenario.
    *
    * @throws skein.units.OwnFailure if the scenario's code throws
    */
  def of(scenario: Scenario, tracks: Tracks): Result = Scenario.told(scenario.name)(Result(
    scenario,
    tracks,
    scenario.measures.map(measure =>
      Measured(measure, measure.of(tracks), isTooShort = measure.over.of(tracks).isEmpty)
    ),
    scenario.series.map(series => (series, series.curve(tracks))),
    scenario.limits.flatMap(_.violations(tracks)).sortBy(_.fromS)
  ))

/** A measure with its value for one flight.
  *
  * @param value None if the flight has none
  * @param isTooShort whether the flight has no value because it is shorter than the measured part
  */
final case class Measured(measure: Measure, value: Option[Double], isTooShort: Boolean)
