package skein.training

import skein.measure.FlightSummary
import skein.optimise.Objective
import skein.scenario.Scenario
import skein.settings.PolicyFile

/** The environment of learning, with its objective.
  *
  * @param scenario the scenario of the flights; its other vehicles use its own policies
  * @param opponent the policy of the other side of a duel
  */
final case class LearnGame(objective: Objective, scenario: Scenario, opponent: Option[PolicyFile] = None):
  export objective.{direction, formula, text, unit}

  /** The result of a flight: the mean distance over the last 10 s of a duel, m, or the scenario's objective.
    */
  def came(flight: FlightSummary): Option[Double] =
    if opponent.isDefined then flight.distance.flatMap(_.lastTenSeconds).map(_.mean)
    else
      flight.result.flatMap: result =>
        val values =
          objective.measures.flatMap((weight, measure) => result.value(measure.name).map(weight * _))
        Option.when(values.sizeIs == objective.terms.size)(values.sum)

  /** Name and unit of the values of [[came]], for tables. */
  def cameTo: (what: String, unit: String) =
    if opponent.isDefined then ("last 10 s", "m") else (formula, unit)
