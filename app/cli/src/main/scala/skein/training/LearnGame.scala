package skein.training

import skein.measure.FlightSummary
import skein.optimise.{Direction, Objective, TeamObjective}
import skein.scenario.Scenario
import skein.settings.PolicyFile

/** The environment of learning, with its objective. */
enum LearnGame:
  /** The paper's duel.
    *
    * @param against the other side
    * @param scenario in which flights take place
    */
  case OfDuel(objective: Objective, against: PolicyFile, scenario: Scenario)

  /** A scenario whose other vehicles use its own policies. */
  case OfTeam(objective: TeamObjective, scenario: Scenario)

  def scenario: Scenario

  /** The opponent's policy, if one is configured. */
  def opponent: Option[PolicyFile] = this match
    case duel: OfDuel => Some(duel.against)
    case _: OfTeam    => None

  def formula: String      = by(_.formula, _.formula)
  def text: String         = by(_.text, _.text)
  def unit: String         = by(_.unit, _.unit)
  def direction: Direction = by(_.direction, _.direction)

  private def by[A](duel: Objective => A, team: TeamObjective => A): A = this match
    case OfDuel(objective, _, _) => duel(objective)
    case OfTeam(objective, _)    => team(objective)

  /** The result of a flight: the mean distance over the last 10 s of a duel, m, or the scenario's objective.
    */
  def came(flight: FlightSummary): Option[Double] = this match
    case _: OfDuel            => flight.distance.flatMap(_.lastTenSeconds).map(_.mean)
    case OfTeam(objective, _) =>
      flight.result.flatMap: result =>
        val values = objective.terms.flatMap((weight, measure) => result.value(measure.name).map(weight * _))
        Option.when(values.sizeIs == objective.terms.size)(values.sum)

  /** Name and unit of the values of [[came]], for tables. */
  def cameTo: (what: String, unit: String) = this match
    case _: OfDuel => ("last 10 s", "m")
    case _: OfTeam => (formula, unit)
