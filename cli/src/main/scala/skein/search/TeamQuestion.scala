package skein.search

import skein.forward.{Delays, Engagement}
import skein.lanes.{TeamBatch, TeamCandidate}
import skein.optimise.{
  Evaluator,
  RunningStats,
  Search,
  SearchMethod,
  TeamEvaluator,
  TeamObjective,
  ValueEvaluator
}
import skein.policy.{Axis, SearchSpace}
import skein.scenario.{Nearest, Scenario, ScenarioKind, Scenarios}
import skein.settings.{ConfigKeys, ScenarioSettings}
import skein.units.Decimals.significant
import skein.units.Expect
import skein.vehicle.VehicleKind
import upickle.default.ReadWriter

/** A setting that is searched between two bounds, by its key. */
final case class Varied(key: String, least: Double, most: Double) derives ReadWriter

object Varied:
  private val Form = """([a-z][a-z0-9-]*)=(-?[\d.]+)\.\.(-?[\d.]+)""".r

  /** Reads `ring-m=4..12`.
    *
    * @return
    *   or what was expected, and what came
    */
  def parse(text: String): Either[String, Varied] = text match
    case Form(key, NumberOf(least), NumberOf(most)) if least < most => Right(Varied(key, least, most))
    case _                                                          =>
      Left(s"expected a setting and its bounds, the lower one first, for example ring-m=4..12, came '$text'")

  private object NumberOf:
    def unapply(text: String): Option[Double] = text.toDoubleOption.filter(_.isFinite)

/** What a search over a scenario's settings is asked, in the words of the user; enough to go on with it, or to ask again.
  *
  * @param set
  *   settings that have one value, by their keys
  * @param objective
  *   a sum of the scenario's measures
  * @param candidates
  *   to be tried in all, about
  * @param episodes
  *   that each flies; when racing, in the first round
  * @param population
  *   of a generation, for the methods that have them
  * @param fresh
  *   episodes on which the winner is measured
  */
final case class TeamQuestion(
    scenario: String,
    set: Map[String, String],
    vary: Vector[Varied],
    objective: String,
    method: String,
    conditions: Conditions,
    link: String,
    candidates: Int,
    episodes: Int,
    population: Int,
    seed: Long,
    fresh: Int
) derives ReadWriter:
  import TeamQuestion.*

  /** @return or what was expected, what came, and in which option */
  def setup(using scenarios: Scenarios): Either[String, TeamSetup] =
    for
      kind  <- scenarios.kind(scenario).left.map("--scenario: " + _)
      _     <- Expect.that(vary.nonEmpty)("--vary: expected a setting to search, for example ring-m=4..12")
      plain <- ScenarioSettings.ofKeys(kind, set).left.map("--set: " + _)
      axes  <- Expect.each(vary)(axis(kind, plain, _))
      _     <- Expect.that(axes.map(_.name).distinct.size == axes.size):
        s"--vary: expected every setting once, came ${vary.map(_.key).mkString(", ")}"
      space = SearchSpace(axes)
      // A setting's bounds may be wrong together with another's.
      corners <-
        Expect.each(
          space.grid(2)
        )(corner => ScenarioSettings.ofKeys(kind, settings(set, space, corner))).left.map("--vary: " + _)
      _ <- Expect.that(corners.forall(corner => altitudesM(corner) == altitudesM(plain))):
        "--vary: expected settings at which all fly as high, since a model of a vehicle holds at its altitude"
      _ <- Expect.that(fresh >= 2 && fresh <= MostFresh)(s"--fresh: expected 2 to $MostFresh, came $fresh")
      _ <- Expect.that(plain.agents.forall(_.kind == VehicleKind.Multirotor)):
        s"--scenario: expected one of multirotors, came ${plain.name}, which has cars: fly and budget fly it"
      flown  <- conditions.copy(altitudeM = altitudesM(plain).head).resolved
      by     <- TeamObjective.parse(objective, plain).left.map("--objective: " + _)
      delays <- Conditions.delays(link).left.map("--link: " + _)
      method <- SearchQuestion.method(method, candidates, episodes, population, vary.size)
    yield TeamSetup(
      this,
      kind,
      space,
      by,
      flown,
      delays,
      method
    )

object TeamQuestion:
  private def altitudesM(scenario: Scenario) = scenario.agents.map(-_.startPositionNed.z)

  private val MostFresh = 1_000_000

  /** Settings by key, with those of a candidate. */
  def settings(set: Map[String, String], space: SearchSpace, candidate: Vector[Double]): Map[String, String] =
    set ++ space.axes.zip(candidate).map((axis, value) => axis.name -> value.toString)

  private def axis(kind: ScenarioKind[?], plain: Scenario, varied: Varied): Either[String, Axis] =
    val defaults = plain.productElementNames.map(ConfigKeys.ofField).zip(plain.productIterator).toMap
    val numbers  = defaults.collect { case (key, value: Double) => key -> value }
    numbers.get(varied.key) match
      case Some(default) =>
        Right(Axis(varied.key, varied.least, varied.most, default.max(varied.least).min(varied.most)))
      case None if defaults.contains(varied.key) =>
        Left(
          s"--vary: expected a setting that measures something, came '${varied.key}', which counts or chooses"
        )
      case None =>
        Left(
          s"--vary: the scenario ${kind.name} has no setting '${varied.key}'; the nearest is '${Nearest.to(varied.key, numbers.keys.toSeq)}'"
        )

/** A search over a scenario's settings, ready to run.
  *
  * @param objective
  *   of the scenario as it is unless told otherwise
  */
final case class TeamSetup(
    question: TeamQuestion,
    kind: ScenarioKind[?],
    space: SearchSpace,
    objective: TeamObjective,
    conditions: Conditions.Resolved,
    delays: Delays,
    by: SearchMethod
) extends ReadySearch:
  val search: Search = Search(space, by, objective.direction, question.seed)

  private val durationS = conditions.duel.durationS
  private val periodS   = conditions.timing.periodS

  def name: String                             = kind.name
  def method: String                           = question.method
  def loop: String                             = question.conditions.loop
  def link: String                             = question.link
  def fresh: Option[Int]                       = Some(question.fresh)
  def label(candidate: Vector[Double]): String = told(candidate, " ")(_.significant(4))
  def subject(axes: String): String = s"${kind.name} of ${scenario(space.defaults).agents.size} ($axes)"

  /** The scenario as it is unless told otherwise. */
  val baseline: Baseline =
    Baseline(
      "plain",
      s"plain ${kind.name}",
      space.axes.map(_.name).zip(space.defaults),
      told(space.defaults, " = ")(SearchResult.number)
    )

  private def told(candidate: Vector[Double], between: String)(number: Double => String) =
    space.axes.zip(candidate).map((axis, value) => axis.name + between + number(value)).mkString(", ")

  private def batch(threads: Int) = TeamBatch(conditions.timing, conditions.vehicle.response, threads)

  def judges(threads: Int): Judge => ValueEvaluator =
    val same = TeamEvaluator(batch(threads), candidate, delays, objective.terms.map(_._1), question.seed)
    _ => same

  def measured(
      by: Judge => Evaluator,
      candidate: Vector[Double],
      episodes: Range
  ): (RunningStats, RunningStats) =
    val tallies = by(Judge.Winner).tallies(Vector(candidate, baseline.candidate), episodes)
    (tallies(0), tallies(1))

  /** The scenario as a candidate has it; its settings were seen to be right. */
  def scenario(candidate: Vector[Double]): Scenario =
    ScenarioSettings
      .ofKeys(kind, TeamQuestion.settings(question.set, space, candidate))
      .fold(mistake => throw IllegalArgumentException(mistake), identity)

  def engine(candidate: Vector[Double], judge: Judge): String =
    val team = this.candidate(candidate)
    val told = asked.engine(team)
    if judge == Judge.Candidates || !asked.fliesByLanes(team) then told
    else s"$told, after a scalar flight of each episode, which makes its timetable"

  def byLanes: Boolean = asked.fliesByLanes(candidate(space.defaults))

  /** Is asked what flies, and flies nothing. */
  private lazy val asked = batch(1)

  def effort: Effort = Effort.ofTeam(byLanes)

  private def candidate(values: Vector[Double]): TeamCandidate =
    val own      = scenario(values)
    val measures = TeamObjective.measures(own).values.map(measure => measure.name -> measure).toMap
    TeamCandidate(
      Engagement.of(own.fleet, durationS),
      TeamObjective.judged(objective.measures.map(each => measures(each.name)), durationS, periodS)
    )

  def formula: String = objective.formula
  def text: String    = objective.text
  def unit: String    = objective.unit

  /** As a configuration that `./skein fly --config` flies. */
  def file(found: Found): (String, String) =
    def interval(tally: RunningStats) = SearchResult.interval(tally, unit)
    val settings                      = TeamQuestion.settings(question.set, space, found.best).toVector.sorted
    val flown                         =
      s"loop ${question.conditions.loop} every ${question.conditions.periodMs} ms over ${question.link}"
    "scenario.conf" ->
      s"""# $text
         |# ${interval(found.fresh)}: mean over ${found.fresh.count} fresh episodes, 95 %; ${interval(
          found.baseline
        )} with ${baseline.label}
         |# found by ./skein search: ${question.method}, ${found.state.flown} episodes, $flown; ${conditions.vehicle.description}
         |skein.fly {
         |  scenario = ${kind.name}
         |  ${kind.name} {
         |${settings.map((key, value) => s"    $key = $value").mkString("\n")}
         |  }
         |}
         |""".stripMargin
