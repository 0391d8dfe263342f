package skein.optimise

import scala.collection.immutable.ListMap
import skein.lanes.TeamOutcomes
import skein.lanes.score.{Effort, Judged}
import skein.policy.Role
import skein.scenario.{Measure, Scenario}
import skein.units.eachBelow

/** The objective of a search: a weighted sum of values of a flight, averaged over episodes.
  *
  * @param terms each term with its weight
  */
final case class Objective(terms: Vector[(Double, Term)], direction: Direction):
  require(terms.nonEmpty, "an objective needs at least one term")

  /** The terms that are measures of a scenario, with their weights. */
  def measures: Vector[(Double, Measure)] = terms.collect { case (weight, ScenarioTerm(measure)) =>
    weight -> measure
  }

  /** The scores that forward simulation computes for this objective; it must support every term.
    */
  def judged(durationS: Double, periodS: Double): Vector[Judged | Effort] =
    terms.flatMap((_, term) => term.judged(durationS, periodS))

  private val firstScores = terms.scanLeft(0)(_ + _._2.size)

  /** The objective's value in one world: [[Objective.Never]] of the worse sign if a measure has none.
    *
    * @param outcomes the values of [[judged]]
    */
  def value(outcomes: TeamOutcomes, world: Int, durationS: Double): Double =
    var sum = 0.0
    eachBelow(terms.size): number =>
      val (weight, term) = terms(number)
      val first          = firstScores(number)
      sum += weight * term.value(score => outcomes.values(first + score)(world), durationS)
    if sum.isNaN && mayLack then direction.sign * Objective.Never else sum

  private val mayLack = measures.exists(_._2.reduced.isEmpty)

  /** The objective as text, without the direction, as [[Objective.ofRole]] and the other methods read it. */
  def formula: String = terms.zipWithIndex
    .map:
      case ((1.0, term), 0)    => term.key
      case ((weight, term), 0) => s"$weight*${term.key}"
      case ((weight, term), _) =>
        val factor = if weight.abs == 1 then "" else s"${weight.abs}*"
        s"${if weight < 0 then "-" else "+"} $factor${term.key}"
    .mkString(" ")

  def text: String = s"${direction.text} $formula"

  /** Unit of the value if all terms have one unit; else empty. */
  def unit: String = terms.map((_, term) => term.unit).distinct match
    case Vector(one) => one
    case _           => ""

  /** The formula with its unit, as a plot's axis label. */
  def title: String = if unit.isEmpty then formula else s"$formula, $unit"

object Objective:
  /** The value of an episode without one of the measures, in the objective's unit: worse, and further from
    * the paused loop's, than that of any episode that has them.
    */
  val Never = 1e6

  /** Reads the objective of one side of a duel: a name, or a sum such as `0.7*last10s + 0.3*effort`,
    * optionally preceded by `minimise` or `maximise`. By default, a sum is minimised, and a single term has
    * the role's direction. The evader is vehicle 0.
    *
    * @param role the role to which `effort` refers
    * @return Left says what was expected, what was given, and at which character
    */
  def ofRole(text: String, role: Role): Either[String, Objective] =
    WeightedSum
      .parse(text, RoleForms)(termOf(role, _, _))
      .map(sum => Objective(sum.terms, sum.stated.getOrElse(naturally(sum.terms, role))))

  private val RoleForms = "last10s, mean, min, effort, capture(RADIUS_M, WITHIN_S), captureTime(RADIUS_M)"

  private def naturally(terms: Vector[(Double, Term)], role: Role): Direction = terms match
    case Vector((1.0, DistanceTerm.Capture(_, _))) =>
      if role == Role.Pursuer then Direction.Maximise else Direction.Minimise
    case Vector((1.0, _: DistanceTerm)) => naturally(role)
    case _                              => Direction.Minimise

  /** The default direction of a role: a pursuer minimises, an evader maximises. */
  def naturally(role: Role): Direction =
    if role == Role.Evader then Direction.Maximise else Direction.Minimise

  private def termOf(role: Role, name: String, arguments: Option[String]): Either[String, Term] =
    val numbers =
      arguments.map(_.split(',').toVector.map(_.trim.toDoubleOption.filter(x => x > 0 && x < 1e6)))
    (name, numbers) match
      case ("last10s", None) => Right(DistanceTerm.Last10s)
      case ("mean", None)    => Right(DistanceTerm.Mean)
      case ("min", None)     => Right(DistanceTerm.Min)
      case ("effort", None)  => Right(EffortTerm(if role == Role.Pursuer then 1 else 0))
      case ("capture", Some(Vector(Some(radiusM), Some(withinS)))) =>
        Right(DistanceTerm.Capture(radiusM, withinS))
      case ("captureTime", Some(Vector(Some(radiusM)))) => Right(DistanceTerm.CaptureTime(radiusM))
      case ("capture", Some(Vector(_, _))) | ("captureTime", Some(Vector(_))) =>
        Left(
          "expected capture(RADIUS_M, WITHIN_S) or captureTime(RADIUS_M) with numbers above 0 and below a million, " +
            s"got '$name(${arguments.get})'"
        )
      case _ => Left(s"expected one of $RoleForms, got '${call(name, arguments)}'")

  private def call(name: String, arguments: Option[String]) = name + arguments.fold("")(a => s"($a)")

  /** The measures of a scenario that forward simulation supports, namely those of a quantity, by key and in
    * their order.
    */
  def measures(scenario: Scenario): ListMap[String, Measure] =
    byKey(scenario.measures.filter(_.parts.nonEmpty))

  private def byKey(measures: Vector[Measure]) =
    measures.map(measure => ScenarioTerm.keyOf(measure) -> measure).to(ListMap)

  /** Reads a weighted sum of a scenario's measures such as `off-ring + 0.1*gap`, optionally preceded by a
    * direction. Only measures of a quantity are allowed, as [[Objective.judged]] requires.
    *
    * @param otherwise the default direction
    * @return Left says what was expected, what was given, and at which character
    */
  def ofQuantities(text: String, scenario: Scenario, otherwise: Direction): Either[String, Objective] =
    val known  = measures(scenario)
    val others = scenario.measures.filter(_.parts.isEmpty).map(ScenarioTerm.keyOf)
    read(text, known, otherwise): name =>
      val note = if others.contains(name) then s": $name is a measure of whole flights" else ""
      if known.isEmpty then (s"another scenario, since ${scenario.name} has no measure of a quantity", note)
      else (s"one of ${known.keys.mkString(", ")}", note)

  /** Reads a weighted sum of any of the scenario's measures; minimises by default. */
  def ofScenario(text: String, scenario: Scenario): Either[String, Objective] =
    val known = byKey(scenario.measures)
    if known.isEmpty then Left(s"expected a scenario with measures; ${scenario.name} has none")
    else read(text, known, Direction.Minimise)(_ => (s"one of ${known.keys.mkString(", ")}", ""))

  /** @param expected the word for a known name in error messages, and a note that follows it */
  private def read(text: String, known: ListMap[String, Measure], otherwise: Direction)(
      expected: String => (String, String)
  ): Either[String, Objective] = WeightedSum
    .parse(text, known.keys.mkString(", "), hyphened = true): (name, arguments) =>
      val (these, note) = expected(name)
      known.get(name).filter(_ => arguments.isEmpty).map(ScenarioTerm(_)).toRight(
        s"expected $these, got '${call(name, arguments)}'$note"
      )
    .map(sum => Objective(sum.terms, sum.stated.getOrElse(otherwise)))
