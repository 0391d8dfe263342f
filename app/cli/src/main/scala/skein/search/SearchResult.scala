package skein.search

import com.typesafe.config.ConfigUtil.quoteString
import com.typesafe.config.{ConfigFactory, ConfigRenderOptions}
import skein.lanes.Engine
import skein.optimise.{Evaluator, RunningStats, SearchState}
import skein.policy.SearchSpace
import skein.report.{Section, TextTable}
import skein.units.Decimals.significant
import skein.units.Interval
import upickle.default.{Writer, writeJs}

/** A search's result, for the terminal and as a table. */
final case class SearchResult(ready: ReadySearch, found: Found):
  import SearchResult.*
  import found.{baseline, fresh}

  private val parameters = ready.space.axes.map(_.name).zip(found.best)

  def summary: String =
    val shown = parameters.take(MostShown).map((name, value) => s"$name = ${value.significant(4)}")
    val more  = parameters.size - shown.size
    s"""best:   ${shown.mkString(", ")}${if more > 0 then s" and $more more" else ""}
       |        ${ready.formula} = ${interval(fresh)} (95 %, ${fresh.count} fresh episodes)
       |${ready.baseline.word}:  ${ready.baseline.label}
       |        ${ready.formula} = ${interval(baseline)}""".stripMargin

  private def interval(tally: RunningStats) = SearchResult.interval(tally, ready.unit)

  def section: Section =
    def row(name: String, parameters: Seq[(String, Double)], tally: RunningStats, engine: Engine) = Vector(
      name,
      parameters.map((parameter, value) => s"$parameter = $value").mkString(", "),
      tally.mean.toString,
      tally.halfWidth95.toString,
      tally.count.toString,
      ready.unit,
      engine.text
    )
    Section(
      s"${ready.formula}, on fresh episodes",
      table = Some(TextTable(
        Vector("<policy", "<parameters", "mean", "± 95 %", "episodes", "<unit", "<engine"),
        Vector(
          row(ready.name, parameters, fresh, ready.engine(found.best, Judge.Winner)),
          row(
            ready.baseline.name,
            ready.baseline.parameters,
            baseline,
            ready.engine(ready.baseline.candidate, Judge.Baseline)
          )
        )
      ))
    )

object SearchResult:
  /** Fresh episodes have numbers from here on: above those of the search and the play-off. */
  val FreshFrom: Int = 1 << 25

  private val MostShown = 12

  /** Number of the winner's fresh episodes, from the first, that are compared with the scalar reference. */
  val Checked = 8

  /** A warning if the scalar reference differs on equal episodes. Single episodes differ when rounding
    * decides at a threshold; means over several hardly do.
    */
  def disagreement(flown: RunningStats, reference: RunningStats, unit: String): Option[String] =
    val allowed = Allowed * reference.mean.abs + flown.halfWidth95 + reference.halfWidth95
    // NaN agrees with nothing.
    Option.unless((flown.mean - reference.mean).abs <= allowed)(
      s"the scalar engine comes to ${interval(reference, unit)} on the same ${reference.count} episodes, and " +
        s"this search to ${interval(flown, unit)}: the policy computes what floats do not hold; fly it before " +
        "you trust it"
    )

  private val Allowed = 0.02

  /** A warning if a candidate lies at limits of the searched space: beyond them may be better. */
  def atLimits(space: SearchSpace, candidate: Vector[Double]): Option[String] =
    val found = space.axes.zip(candidate).collect:
      case (axis, value) if axis.margin(value) <= NearLimit =>
        val limit =
          if value < (axis.least + axis.most) / 2 then s"least, ${axis.least}" else s"most, ${axis.most}"
        s"${axis.name} at the $limit"
    Option.when(found.nonEmpty)(
      s"the best lies at a limit of what was searched: ${found.mkString(" and ")}; farther on may be better"
    )

  /** Distance from a limit that counts as at it, as a fraction of the axis. */
  private val NearLimit = 0.01

  /** @param state a state with a best candidate
    * @param isCancelled checked from time to time, from any thread
    * @return None if it was cancelled
    */
  def measured(
      ready: ReadySearch,
      by: Judge => Evaluator,
      state: SearchState,
      episodes: Int,
      isCancelled: () => Boolean = () => false
  ): Option[Found] =
    val best                                           = state.best.get.candidate
    val fresh                                          = FreshFrom until FreshFrom + episodes
    def tally(judge: Judge, candidate: Vector[Double]) =
      by(judge).talliesUnless(isCancelled)(Vector(candidate), fresh).map(_.head)
    for
      winner   <- tally(Judge.Winner, best)
      baseline <- tally(Judge.Baseline, ready.baseline.candidate)
    yield Found(state, best, winner, baseline)

  /** A mean with the half width of its 95 % interval, which equal values cannot give: all of 64 episodes may
    * end in a capture, and one of the next 64 not.
    */
  def interval(tally: RunningStats, unit: String): String =
    if tally.count > 1 && tally.sd == 0 then s"${tally.mean.significant(4)} $unit".trim + " in each"
    else s"${Interval.of(tally.mean, tally.halfWidth95).text} $unit".trim

  /** The last remarks of a policy file: the question that its policy answers, as it is stored, with its
    * conditions.
    *
    * @param how fields on how it was answered, which replace the question's fields of these names
    */
  def question[Q: Writer](name: String, asked: Q, how: (String, ujson.Value)*): String =
    val fields     = writeJs(asked).obj
    val conditions = fields.remove("conditions").toVector.flatMap(_.obj)
    ConfigFactory
      .parseString(ujson.Obj.from(fields.toVector ++ conditions ++ how).render())
      .atKey(name)
      .root
      .render(ConfigRenderOptions.defaults.setOriginComments(false).setJson(false))

  /** The first remarks of a policy file: the results of its policy and of the paper's policy. */
  def objective(
      text: String,
      unit: String,
      fresh: RunningStats,
      paperName: String,
      paper: RunningStats
  ): String =
    s"""objective {
       |  formula = ${quoteString(text)}
       |  # mean over fresh episodes; the true one lies within ± halfWidth95 with 95 % confidence, unless it is 0
       |  mean = ${fresh.mean}
       |  halfWidth95 = ${fresh.halfWidth95}
       |  sd = ${fresh.sd}
       |  episodes = ${fresh.count}
       |  unit = ${quoteString(unit)}
       |  # $paperName with the paper's constants, on the same episodes
       |  paperMean = ${paper.mean}
       |  paperHalfWidth95 = ${paper.halfWidth95}
       |}
       |""".stripMargin
