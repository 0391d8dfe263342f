package skein.search

import java.util.Locale
import skein.forward.{Delays, Engagement}
import skein.lanes.{Judged, TeamBatch, TeamCandidate}
import skein.optimise.{
  Direction,
  Evaluator,
  Search,
  SearchMethod,
  SearchState,
  Tally,
  TeamEvaluator,
  WeightedSum
}
import skein.policy.SearchSpace
import skein.scenario.{Measure, OverFlight, Scenario, ScenarioKind, Window}

/** A search over a scenario's settings, ready to run.
  *
  * @param terms
  *   weights and measures of the objective
  */
final case class TeamSetup(
    question: TeamQuestion,
    kind: ScenarioKind[?],
    space: SearchSpace,
    terms: Vector[(Double, Measure)],
    direction: Direction,
    conditions: Conditions.Resolved,
    delays: Delays,
    method: SearchMethod
):
  val search: Search = Search(space, method, direction, question.seed)

  private val durationS = conditions.duel.durationS
  private val periodS   = conditions.timing.periodS

  def batch(threads: Int): TeamBatch = TeamBatch(conditions.timing, conditions.vehicle.response, threads)

  def evaluator(batch: TeamBatch): Evaluator =
    TeamEvaluator(batch, candidate, delays, terms.map(_._1), question.seed)

  /** The scenario as a candidate has it; its settings were seen to be right. */
  def scenario(candidate: Vector[Double]): Scenario =
    TeamQuestion
      .read(kind, TeamQuestion.settings(question.set, space, candidate))
      .fold(mistake => throw IllegalArgumentException(mistake), identity)

  /** A line that says what flies the candidates. */
  def engine(batch: TeamBatch): String = batch.engine(candidate(space.defaults))

  def fliesByLanes(batch: TeamBatch): Boolean = batch.fliesByLanes(candidate(space.defaults))

  private def candidate(values: Vector[Double]): TeamCandidate =
    val own      = scenario(values)
    val measures = TeamQuestion.measures(own).values.map(measure => measure.name -> measure).toMap
    TeamCandidate(
      Engagement.of(own.fleet, durationS),
      terms.map((_, measure) => judged(measures(measure.name).reduced.get))
    )

  private def judged(by: OverFlight): Judged = Judged(
    by.quantity,
    by.reduction,
    by.over match
      case Window.Whole          => 0
      case Window.After(seconds) => seconds
      case Window.Last(seconds)  => durationS - math.floor(seconds / periodS + 1e-9) * periodS
  )

  /** As users write it, without the direction. */
  def formula: String = WeightedSum.formula(terms)((measure: Measure) => measure.name.replace(' ', '-'))

  def text: String = s"${direction.text} $formula"

  /** Of the value, where all terms agree. */
  def unit: String = if terms.map(_._2.unit).distinct.size == 1 then terms.head._2.unit else ""

/** What a search over a scenario's settings came to, measured on episodes that the search never met.
  *
  * @param plain
  *   the scenario as it is unless told otherwise, on the same episodes
  */
final case class TeamSearchResult(
    setup: TeamSetup,
    state: SearchState,
    best: Vector[Double],
    fresh: Tally,
    plain: Tally
):
  import TeamSearchResult.number

  private def interval(tally: Tally): String =
    s"${number(tally.mean)} ± ${number(tally.halfWidth95)}${
        if setup.unit.isEmpty then "" else s" ${setup.unit}"
      }"

  private def told(candidate: Vector[Double]): String =
    setup.space.axes.zip(candidate).map((axis, value) => s"${axis.name} = ${number(value)}").mkString(", ")

  /** For the terminal. */
  def summary: String =
    s"""best:   ${told(best)}
       |        ${setup.formula} = ${interval(fresh)} (95 %, ${fresh.count} fresh episodes)
       |plain:  ${told(setup.space.defaults)}
       |        ${setup.formula} = ${interval(plain)}""".stripMargin

  /** As a configuration that `./skein fly --config` flies. */
  def file: String =
    val settings = TeamQuestion.settings(setup.question.set, setup.space, best).toVector.sorted
    s"""# ${setup.text}
       |# ${interval(fresh)}: mean over ${fresh.count} fresh episodes, 95 %; ${interval(plain)} with ${told(
        setup.space.defaults
      )}
       |# found by ./skein search: ${setup.question.method}, ${state.flown} episodes, loop ${setup.question.conditions.loop} every ${setup.question.conditions.periodMs} ms over ${setup.question.link}; ${setup.conditions.vehicle.description}
       |skein.fly {
       |  scenario = ${setup.kind.name}
       |  ${setup.kind.name} {
       |${settings.map((key, value) => s"    $key = $value").mkString("\n")}
       |  }
       |}
       |""".stripMargin

object TeamSearchResult:
  /** @param state
    *   with a best candidate
    */
  def measured(setup: TeamSetup, batch: TeamBatch, state: SearchState, episodes: Int): TeamSearchResult =
    val best    = state.best.get.candidate
    val range   = SearchResult.FreshFrom until SearchResult.FreshFrom + episodes
    val tallies = setup.evaluator(batch).tallies(Vector(best, setup.space.defaults), range)
    TeamSearchResult(setup, state, best, tallies(0), tallies(1))

  private def number(value: Double): String = String.format(Locale.ROOT, "%.4g", value)
