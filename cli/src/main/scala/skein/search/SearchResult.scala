package skein.search

import java.util.Locale
import skein.lanes.DuelBatch
import skein.optimise.{Evaluator, SearchState, RunningStats}
import skein.policy.PolicyFamily
import skein.report.Section
import skein.settings.{PolicyFile, VehicleChoice}

/** What a search came to, measured on episodes that the search never met.
  *
  * @param paper
  *   the paper's policy of the same role on the same episodes
  */
final case class SearchResult(
    setup: SearchSetup,
    state: SearchState,
    policy: PolicyFile,
    fresh: RunningStats,
    paper: RunningStats
):
  import SearchResult.number

  private def interval(tally: RunningStats): String =
    s"${number(tally.mean)} ± ${number(tally.halfWidth95)}${if unit.isEmpty then "" else s" $unit"}"

  private def unit: String = setup.objective.unit

  /** For the terminal. */
  def summary: String =
    val parameters = setup.family.space.axes.zip(policy.parameters).take(12).map((axis, value) =>
      s"${axis.name} = ${number(value)}"
    )
    val more = setup.family.space.dimension - parameters.size
    s"""best:   ${parameters.mkString(", ")}${if more > 0 then s" and $more more" else ""}
       |        ${setup.objective.formula} = ${interval(fresh)} (95 %, ${fresh.count} fresh episodes)
       |paper:  ${PolicyFile.ofDefaults(setup.role, setup.paper).label}
       |        ${setup.objective.formula} = ${interval(paper)}""".stripMargin

  /** As a table: what was found, and the paper's policy beside it. */
  def section: Section =
    def named(family: PolicyFamily, values: Seq[Double]) = family.space.axes.map(_.name).zip(values)
    SearchTable.of(setup.objective.formula, unit)(
      (setup.family.name, named(setup.family, policy.parameters), fresh),
      (setup.paper.name, named(setup.paper, setup.paper.space.defaults), paper)
    )

  /** As a policy file. */
  def file: String =
    val question = setup.question
    policy.hocon(
      s"""objective {
         |  formula = "${setup.objective.text}"
         |  # mean over fresh episodes; the true one lies within ± halfWidth95 with 95 % confidence
         |  mean = ${fresh.mean}
         |  halfWidth95 = ${fresh.halfWidth95}
         |  sd = ${fresh.sd}
         |  episodes = ${fresh.count}
         |  unit = "$unit"
         |  # ${setup.paper.name} with the paper's constants, on the same episodes
         |  paperMean = ${paper.mean}
         |  paperHalfWidth95 = ${paper.halfWidth95}
         |}
         |found {
         |  by = "./skein search"
         |  complete = ${state.isDone}
         |  method = ${question.method}
         |  loop = ${question.conditions.loop}
         |  periodMs = ${question.conditions.periodMs}
         |  link = "${question.link}"
         |  plant = "${question.conditions.plant}"
         |  vehicles = "${setup.conditions.vehicle.description}"
         |  opponent = "${question.opponent}"
         |  altitudeM = ${question.conditions.altitudeM}
         |  durationS = ${question.conditions.durationS}
         |  candidates = ${question.candidates}
         |  episodesEach = ${question.episodes}
         |  population = ${question.population}
         |  episodesFlown = ${state.flown}
         |  seed = ${question.seed}
         |}
         |""".stripMargin
    )

object SearchResult:
  /** Fresh episodes count from here: above the search's own and the play-off's. */
  val FreshFrom: Int = 1 << 25

  /** @param state
    *   with a best candidate
    */
  def measured(setup: SearchSetup, by: Judge => Evaluator, state: SearchState, episodes: Int): SearchResult =
    val best  = state.best.get.candidate
    val range = FreshFrom until FreshFrom + episodes
    SearchResult(
      setup,
      state,
      PolicyFile(setup.role, setup.family, best),
      by(Judge.Winner).tallies(Vector(best), range).head,
      by(Judge.Paper).tallies(Vector(setup.paper.space.defaults), range).head
    )

  private def number(value: Double): String = String.format(Locale.ROOT, "%.4g", value)

/** How much is flown beside the search itself: less where an episode costs more. */
final case class Effort(freshEpisodes: Int, landscapeEpisodes: Int, onMap: Int, cellEpisodes: Int):
  /** With no more episodes for a point of the landscape than the winner is measured on. */
  def within(fresh: Int): Effort = copy(landscapeEpisodes = landscapeEpisodes.min(fresh))

object Effort:
  /** Episodes that one core flies in about half a second. */
  def blockEpisodes(byLanes: Boolean, vehicle: VehicleChoice): Int =
    (byLanes, vehicle.name == "quadrotor") match
      case (true, false)  => 32768
      case (true, true)   => 2048
      case (false, false) => 512
      case (false, true)  => 16

  private val Cheap  = Effort(4096, 256, Landscape.OnMap, 1000)
  private val Dear   = Effort(512, 16, 21, 30)
  private val Dearer = Effort(64, 4, 13, 4)

  def of(setup: SearchSetup, batch: DuelBatch): Effort =
    of(setup.isFast(batch), setup.isFast(batch, many = false), setup.conditions.vehicle)

  /** @param together
    *   whether candidates that share their episodes fly by lanes
    * @param alone
    *   whether worlds with delays of their own do
    */
  def of(together: Boolean, alone: Boolean, vehicle: VehicleChoice): Effort =
    def level(byLanes: Boolean) = (byLanes, vehicle.name == "quadrotor") match
      case (true, false)                 => Cheap
      case (true, true) | (false, false) => Dear
      case (false, true)                 => Dearer
    val (candidates, worlds) = (level(together), level(alone))
    Effort(worlds.freshEpisodes, candidates.landscapeEpisodes, candidates.onMap, worlds.cellEpisodes)
