package skein.optimise

import scala.collection.immutable.ListMap
import skein.lanes.score.Judged
import skein.policy.Role
import skein.scenario.{Measure, Scenario, Window}

/** The objective for flights of a scenario: a sum of its measures.
  *
  * @param terms weights and measures; forward simulation supports those of a quantity
  */
final case class TeamObjective(terms: Vector[(Double, Measure)], direction: Direction)
    extends SummedMeasures[Measure](TeamObjective.keyOf, _.unit):

  def measures: Vector[Measure] = terms.map((_, measure) => measure)

object TeamObjective:

  /** A scenario's measures that forward simulation supports, by their keys: those of a quantity, in their
    * order.
    */
  def measures(scenario: Scenario): ListMap[String, Measure] =
    scenario.measures.filter(_.reduced.nonEmpty).map(measure => keyOf(measure) -> measure).to(ListMap)

  def keyOf(measure: Measure): String = measure.name.replace(' ', '-')

  /** Reads `off-ring + 0.1*gap`, with an optional direction before it: measures of a quantity, as [[judged]]
    * requires.
    *
    * @param otherwise the default direction
    * @return Left states what was expected, what was given, and at which character
    */
  def parse(
      text: String,
      scenario: Scenario,
      otherwise: Direction = Direction.Minimise
  ): Either[String, TeamObjective] = read(text, measures(scenario), otherwise)(measureOf(scenario, _, _))

  /** Reads a sum of any measures of the scenario; minimises by default. */
  def ofAll(text: String, scenario: Scenario): Either[String, TeamObjective] =
    val known = scenario.measures.map(measure => keyOf(measure) -> measure).to(ListMap)
    if known.isEmpty then Left(s"expected a scenario with measures; ${scenario.name} has none")
    else
      read(text, known, Direction.Minimise): (name, arguments) =>
        known.get(name).filter(_ => arguments.isEmpty).toRight(
          s"expected one of ${known.keys.mkString(", ")}, came '$name${arguments.fold("")(a => s"($a)")}'"
        )

  private def read(text: String, known: ListMap[String, Measure], otherwise: Direction)(
      measureOf: (String, Option[String]) => Either[String, Measure]
  ): Either[String, TeamObjective] =
    WeightedSum
      .parse(text, known.keys.mkString(", "), hyphened = true)(measureOf)
      .map(sum => TeamObjective(sum.terms, sum.stated.getOrElse(otherwise)))

  /** The numbers that measures of a quantity need of an episode. */
  def judged(measures: Vector[Measure], durationS: Double, periodS: Double): Vector[Judged] =
    measures.map(_.reduced.get).map(by =>
      Judged(
        by.quantity,
        by.reduction,
        by.over match
          case Window.Whole          => 0
          case Window.After(seconds) => seconds
          case Window.Last(seconds)  => durationS - math.floor(seconds / periodS + 1e-9) * periodS
      )
    )

  /** The default direction: a pursuer minimises the measure, an evader maximises it. */
  def naturally(role: Role): Direction =
    if role == Role.Evader then Direction.Maximise else Direction.Minimise

  private def measureOf(
      scenario: Scenario,
      name: String,
      arguments: Option[String]
  ): Either[String, Measure] =
    val known = measures(scenario)
    (known.get(name), arguments) match
      case (Some(measure), None) => Right(measure)
      case _                     =>
        val others = scenario.measures.filter(_.reduced.isEmpty).map(keyOf)
        val note   = if others.contains(name) then s": $name is told of recorded flights alone" else ""
        val these  =
          if known.isEmpty then s"another scenario, since ${scenario.name} has no measure of a quantity"
          else s"one of ${known.keys.mkString(", ")}"
        Left(s"expected $these, came '$name${arguments.fold("")(a => s"($a)")}'$note")
