package skein.measure

import skein.scenario.Scenario

/** Names of scenarios that are shown together. Where several have one name, the settings in which they differ
  * follow, or a number if these are long.
  */
private[skein] final class ScenarioNames private (names: Map[Scenario, String]):
  def apply(scenario: Scenario): String = names.getOrElse(scenario, scenario.name)

private[skein] object ScenarioNames:
  private val MostLetters = 60

  def of(scenarios: Iterable[Scenario]): ScenarioNames =
    ScenarioNames(scenarios.toVector.distinct.groupBy(_.name).flatMap:
      case (name, Vector(one)) => Map(one -> name)
      case (name, several)     => several.zip(named(name, several)))

  private def named(name: String, several: Vector[Scenario]): Vector[String] =
    val values = several.map(_.settings.toMap)
    val differ =
      several.head.settings.map(_._1).filter(setting => values.map(_.get(setting)).distinct.size > 1)
    val words =
      values.map(own => differ.map(setting => s"$setting ${own.getOrElse(setting, "")}").mkString(", "))
    if words.distinct.size < words.size || words.exists(_.length > MostLetters) then
      several.indices.toVector.map(index => s"$name ${index + 1}")
    else words.map(settings => s"$name, $settings")

  /** The name of each flight's scenario; empty if all flights are of one, with equal settings. */
  def among(flights: Seq[FlightSummary]): FlightSummary => String =
    if flights.map(one => (one.flight.scenario, one.scenario)).distinct.sizeIs <= 1 then _ => ""
    else
      val names = of(flights.flatMap(_.scenario))
      one => one.scenario.fold(one.flight.scenario)(names(_))
