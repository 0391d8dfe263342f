package skein.search

import java.util.Locale
import skein.optimise.{Evaluator, SearchState, RunningStats}
import skein.report.Section

/** What a search over a scenario's settings came to, measured on episodes that the search never met.
  *
  * @param plain
  *   the scenario as it is unless told otherwise, on the same episodes
  */
final case class TeamSearchResult(
    setup: TeamSetup,
    state: SearchState,
    best: Vector[Double],
    fresh: RunningStats,
    plain: RunningStats
):
  import TeamSearchResult.number

  private def interval(tally: RunningStats): String =
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

  /** As a table: what was found, and the plain scenario beside it. */
  def section: Section =
    def named(values: Seq[Double]) = setup.space.axes.map(_.name).zip(values)
    SearchTable.of(setup.formula, setup.unit)(
      (setup.kind.name, named(best), fresh),
      (s"plain ${setup.kind.name}", named(setup.space.defaults), plain)
    )

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
  def measured(
      setup: TeamSetup,
      by: Judge => Evaluator,
      state: SearchState,
      episodes: Int
  ): TeamSearchResult =
    val best    = state.best.get.candidate
    val range   = SearchResult.FreshFrom until SearchResult.FreshFrom + episodes
    val tallies = by(Judge.Winner).tallies(Vector(best, setup.space.defaults), range)
    TeamSearchResult(setup, state, best, tallies(0), tallies(1))

  private def number(value: Double): String = String.format(Locale.ROOT, "%.4g", value)
