package skein.optimise

import scala.collection.immutable.ListMap
import skein.lanes.score.Judged
import skein.policy.Role
import skein.scenario.{Measure, Scenario, Window}

/** What flights of a scenario are judged by: a sum of its measures.
  *
  * @param terms weights and measures; of a quantity, where forward simulation judges by them
  */
final case class TeamObjective(terms: Vector[(Double, Measure)], direction: Direction):

  def formula: String = WeightedSum.formula(terms)((measure: Measure) => TeamObjective.keyOf(measure))
  def text: String    = s"${direction.text} $formula"
  def unit: String    = WeightedSum.unit(terms)((measure: Measure) => measure.unit)

  /** The terms' measures. */
  def measures: Vector[Measure] = terms.map((_, measure) => measure)

object TeamObjective:

  /** A scenario's measures that forward simulation can judge by, by their keys: those of a quantity, in their
    * order.
    */
  def measures(scenario: Scenario): ListMap[String, Measure] =
    scenario.measures.filter(_.reduced.nonEmpty).map(measure => keyOf(measure) -> measure).to(ListMap)

  /** `off ring` as `off-ring`. */
  def keyOf(measure: Measure): String = measure.name.replace(' ', '-')

  /** Reads `off-ring + 0.1*gap`, with a direction before it or not: measures of a quantity, as [[judged]]
    * wants them.
    *
    * @param otherwise the direction where none stands there
    * @return or what was expected, what came, and at which character
    */
  def parse(
      text: String,
      scenario: Scenario,
      otherwise: Direction = Direction.Minimise
  ): Either[String, TeamObjective] = read(text, measures(scenario), otherwise)(measureOf(scenario, _, _))

  /** Reads the same of any measures of the scenario, small where no direction stands there. */
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

  /** What measures of a quantity judge an episode by. */
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

  /** Where nothing else is said, a pursuer wants little of what is measured, an evader much. */
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
