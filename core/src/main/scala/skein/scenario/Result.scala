package skein.scenario

/** What a flight came to.
  *
  * @param measured
  *   the first stands for the flight when it is compared with others
  * @param violations
  *   of all limits, in the order of their times
  */
final case class Result(
    scenario: Scenario,
    tracks: Tracks,
    measured: Vector[Measured],
    curves: Vector[(Series, Curve)],
    violations: Vector[Violation]
):
  /** What a measure came to, by its name; absent where the flight never came to it. */
  def value(measure: String): Option[Double] =
    measured
      .find(_.measure.name == measure)
      .getOrElse(throw IllegalArgumentException(
        s"no measure '$measure'; there are: ${measured.map(_.measure.name).mkString(", ")}"
      ))
      .value

object Result:
  def of(scenario: Scenario, tracks: Tracks): Result = Result(
    scenario,
    tracks,
    scenario.measures.map(measure => Measured(measure, measure.of(tracks))),
    scenario.series.map(series => (series, series.curve(tracks))),
    scenario.limits.flatMap(_.violations(tracks)).sortBy(_.fromS)
  )

/** @param value
  *   absent where the flight never came to it
  */
final case class Measured(measure: Measure, value: Option[Double])
