package skein.search

import com.typesafe.config.ConfigUtil.quoteString
import skein.forward.Engagement
import skein.lanes.Engine
import skein.optimise.{Objective, RunningStats, ScenarioTerm}
import skein.pickle.Fields
import skein.policy.{Axis, SearchSpace}
import skein.scenario.{Nearest, Scenario, ScenarioKind, ScenarioText, Scenarios}
import skein.settings.{ConfigKeys, LinkText, ScenarioSettings}
import skein.units.Decimals.significant
import skein.units.Expect

/** The question of a search over a scenario's settings.
  *
  * @param set the settings with fixed values, by key
  * @param objective a sum of the scenario's measures
  * @param candidates approximate number of candidates to evaluate
  * @param episodes number of episodes for each candidate; when racing, in the first round
  * @param population number of candidates in a generation, for methods that have them
  * @param fresh number of episodes for the winner
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
) extends PosedSearch derives Fields:
  import TeamQuestion.*

  def setup(using scenarios: Scenarios): Either[String, ReadySearch] =
    for
      ready <- read(plantIsTold = conditions.plant != Plant)
      _     <- Expect.that(!ready.isVirtual || ready.search.expected <= WholeFlights.MostVirtual):
        s"--candidates, --episodes: expected at most ${WholeFlights.MostVirtual} " +
          s"flights in virtual time, got some ${ready.search.expected}"
    yield ready

  /** Resolves the question like `setup`, but with any number of flights.
    *
    * @param plantIsTold whether a user chose the plant
    */
  def read(plantIsTold: Boolean)(using scenarios: Scenarios): Either[String, ReadySearch] =
    for
      kind  <- scenarios.kind(scenario).left.map("--scenario: " + _)
      _     <- Expect.that(vary.nonEmpty)("--vary: expected a setting to search, for example ring-m=4..12")
      plain <- ScenarioSettings.ofKeys(kind, set).left.map("--set: " + _)
      axes  <- Expect.each(vary)(axis(kind, plain, _))
      _     <- Expect.that(!vary.exists(each => set.contains(each.key))):
        s"--set: ${vary.map(_.key).filter(set.contains).mkString(", ")} is searched by --vary; expected one of both"
      _ <- Expect.that(axes.map(_.name).distinct.size == axes.size):
        s"--vary: expected every setting once, got ${vary.map(_.key).mkString(", ")}"
      space = SearchSpace(axes)
      // A setting's bounds may be invalid only in combination with another setting's bounds.
      corners <-
        Expect.each(
          space.grid(2)
        )(corner => ScenarioSettings.ofKeys(kind, settings(set, space, corner))).left.map("--vary: " + _)
      _  <- Expect.within("--fresh", fresh, 2, MostFresh)
      by <- Objective.ofScenario(objective, plain).left.map("--objective: " + _)
      // A measure's name may contain a setting's value.
      _      <- Expect.each(corners)(Objective.ofScenario(objective, _)).left.map("--objective, --vary: " + _)
      engine <- engine(by, plain +: corners, plantIsTold)
      method <- SearchQuestion.method(method, candidates, episodes, population, vary.size)
    yield ReadySearch(this, SearchedScenario(this, kind, space, plain), by, engine, method, Some(fresh), seed)

  /** Chooses the engine: SIMD, if forward simulation supports the policies and the measures; world by world,
    * if measures are of whole flights; else flights in virtual time.
    *
    * @param all the scenario with the plain settings, first, and with the bounds of the searched ones
    */
  private def engine(by: Objective, all: Vector[Scenario], plantIsTold: Boolean)(using
      Scenarios
  ): Either[String, TeamEngine] =
    Expect.each(all)(WholeFlights.engagement(_, conditions.durationS)) match
      case Left(reason) =>
        for
          _       <- Expect.that(!plantIsTold)(WholeFlights.noPlant(reason))
          loop    <- conditions.checked
          profile <- LinkText.profile(link).left.map("--link: " + _)
        yield TeamEngine.Whole(WholeFlights.virtual(conditions, loop, profile, seed, reason))
      case Right(engagements) =>
        val moved = Option.when(all.exists(altitudesM(_) != altitudesM(all.head)))(
          "what is searched changes how high they fly, and models of level flight hold at one altitude"
        )
        for
          plant <- WholeFlights.plant(
            engagements.head,
            engagements.flatMap(WholeFlights.climbs).headOption.orElse(moved),
            conditions.plant,
            plantIsTold
          )
          flown  <- conditions.copy(plant = plant, altitudeM = Conditions.altitudeM(all.head)).resolved
          delays <- flown.delays(link, engagements.head.agents.size).left.map("--link: " + _)
        yield WholeFlights
          .whole(engagements.head, by)
          .fold(TeamEngine.Reduced(flown, delays)): why =>
            TeamEngine.Whole(WholeFlights.scalar(flown, delays, seed, why))

object TeamQuestion:
  /** The default plant: teams fly low, where the model of three parameters is not valid. */
  val Plant = "drag"

  private def altitudesM(scenario: Scenario) = scenario.agents.map(-_.startPositionNed.z)

  private val MostFresh = 1_000_000

  /** The settings by key, with those of a candidate. */
  def settings(set: Map[String, String], space: SearchSpace, candidate: Vector[Double]): Map[String, String] =
    set ++ space.axes.zip(candidate).map((axis, value) => axis.name -> value.toString)

  private def valuesOf(scenario: Scenario): Map[String, Any] =
    scenario.productElementNames.map(ConfigKeys.ofField).zip(scenario.productIterator).toMap

  /** The settings that can be searched, by key. */
  private[search] def numbersOf(scenario: Scenario): Map[String, Double] =
    valuesOf(scenario).collect { case (key, value: Double) => key -> value }

  private def axis(kind: ScenarioKind[?], plain: Scenario, varied: Varied): Either[String, Axis] =
    val numbers = numbersOf(plain)
    numbers.get(varied.key) match
      case Some(default) =>
        Right(Axis(varied.key, varied.least, varied.most, default.max(varied.least).min(varied.most)))
      case None if valuesOf(plain).contains(varied.key) =>
        Left(
          s"--vary: expected a setting that measures something, got '${varied.key}', which counts or chooses"
        )
      case None =>
        Left(
          s"--vary: the scenario ${kind.name} has no setting '${varied.key}'; the " +
            s"nearest is '${Nearest.to(varied.key, numbers.keys.toSeq)}'"
        )

/** A scenario's settings within their bounds; each candidate is one scenario.
  *
  * @param plain the scenario without the searched settings
  */
private final class SearchedScenario(
    question: TeamQuestion,
    kind: ScenarioKind[?],
    val space: SearchSpace,
    plain: Scenario
) extends Searched:
  import question.conditions.durationS

  def name: String                             = kind.name
  def label(candidate: Vector[Double]): String = told(candidate, " ")(_.significant(4))
  def subject(axes: String): String   = s"${kind.name} of ${scenario(space.defaults).agents.size} ($axes)"
  def isFast(engine: Engine): Boolean = engine.fliesByLanes

  /** The scenario with its own settings, which may lie outside of the searched bounds. */
  val baseline: Baseline =
    val own = TeamQuestion.numbersOf(plain)
    val all = space.axes.map(axis => axis.name -> own(axis.name))
    Baseline("plain", s"${kind.name}, unchanged", all, told(all.map(_._2), " = ")(_.significant(4)))

  private def told(candidate: Vector[Double], between: String)(number: Double => String) =
    space.axes.zip(candidate).map((axis, value) => axis.name + between + number(value)).mkString(", ")

  /** The scenario with a candidate's settings, which have been validated. */
  def scenario(candidate: Vector[Double]): Scenario =
    ScenarioSettings
      .candidate(kind, TeamQuestion.settings(question.set, space, candidate))
      .fold(mistake => throw IllegalArgumentException(mistake), identity)

  def team(candidate: Vector[Double], judge: Judge, by: Objective): (Engagement, Objective) =
    val flown = scenario(candidate)
    val own   = Objective.measures(flown).values.map(each => each.name -> each).toMap
    val terms = by.measures.map((weight, measure) => (weight, ScenarioTerm(own(measure.name))))
    (Engagement.ofScenario(flown, durationS), by.copy(terms = terms))

  override lazy val isAtOnePace: Boolean =
    val paces =
      (baseline.candidate +: space.defaults +: space.grid(2)).map(scenario(_).agents.map(each =>
        (each.speed, each.startHeading)
      ))
    paces.distinct.size == 1

  def effort(together: Engine, alone: Engine, by: Conditions.Resolved): Effort = Effort.ofTeam(together)

  /** Name and text of a configuration with the result, for `./skein fly --config`. */
  def file(found: Found, of: ReadySearch): (String, String) =
    def interval(tally: RunningStats) = SearchResult.interval(tally, of.unit)
    val settings                      = TeamQuestion.settings(question.set, space, found.best).toVector.sorted
    val flown                         =
      s"loop ${question.conditions.loopText} every ${question.conditions.periodMs} ms over ${question.link}"
    "scenario.conf" ->
      s"""# ${of.text}
         |# ${interval(found.fresh)}: mean over ${found.fresh.count} fresh episodes, 95 %; ${interval(
          found.baseline
        )} with ${baseline.label}
         |# found by ./skein search: ${question.method}, ${found.state.flown} episodes, $flown; ${of.vehicles}
         |skein.fly {
         |  scenario = ${
          if ScenarioText.isText(question.scenario) then quoteString(question.scenario) else kind.name
        }
         |  ${kind.name} {
         |${settings.map((key, value) => s"    $key = ${quoteString(value)}").mkString("\n")}
         |  }
         |}
         |""".stripMargin
