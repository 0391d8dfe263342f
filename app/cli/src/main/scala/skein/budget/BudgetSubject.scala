package skein.budget

import skein.forward.{DelayTable, Engagement}
import skein.lanes.{Engine, TeamCandidate, TeamWorlds}
import skein.optimise.{Objective, RunningStats}
import skein.search.{Conditions, Effort}
import skein.signal.LatencyDistribution
import skein.simd.WorldRandom

/** What a budget simulates, for people.
  *
  * @param loop name of the loop
  * @param vehicles the vehicle model, in a line
  * @param label description of the policy, or of the scenario
  * @param formula formula of the value, in `unit`, which may be empty
  */
final case class BudgetTask(
    loop: String,
    periodMs: Double,
    durationS: Double,
    vehicles: String,
    label: String,
    formula: String,
    unit: String
)

/** The subject of a budget: its simulation over links yields a value. */
trait BudgetSubject(val task: BudgetTask):
  /** The value in a world that stands still while the controller decides; Left says why there is none.
    *
    * @param episodes number of the cells' episodes over which it is averaged if readings have errors; without
    *   errors, one is simulated
    */
  def truth(episodes: Int): Either[String, Double]

  def engine(links: Vector[LatencyDistribution]): Engine

  /** Number of episodes of a cell that are simulated within seconds. */
  def cellEpisodes(links: Vector[LatencyDistribution]): Int

  /** Number of rows of a map that one call simulates. */
  def rowsTogether: Int = 1

  /** The statistics of each cell; all cells use equal random numbers.
    *
    * @return Left says why there are none
    */
  def tallies(cells: BudgetCells): Either[String, Vector[RunningStats]]

/** Cells of a map that are to be simulated.
  *
  * @param links the links' round trips
  * @param episodes number of episodes for each link
  * @param onProgress called with the number of episodes done
  */
final case class BudgetCells(
    links: Vector[LatencyDistribution],
    episodes: Int,
    onProgress: Long => Unit = _ => (),
    isCancelled: () => Boolean = () => false
)

object BudgetSubject:
  val Stopped = "stopped before the map was whole"

/** A team in forward simulation, whose episodes yield values of an objective.
  *
  * @param team the team simulated over links
  * @param atRest the team simulated in a world that stands still while the controller decides
  * @param effort default number of episodes, by engine
  */
final class TeamSubject(
    named: Conditions,
    flown: Conditions.Resolved,
    label: String,
    team: Engagement,
    atRest: Engagement,
    objective: Objective,
    effort: Engine => Effort,
    seed: Long,
    threads: Int
) extends BudgetSubject(BudgetTask(
      named.loopText,
      named.periodMs,
      named.durationS,
      flown.vehicle.description,
      label,
      objective.formula,
      objective.unit
    )):
  import task.durationS
  private val batch     = flown.batch(threads)
  private val candidate = of(team)

  private def of(team: Engagement) = TeamCandidate(team, objective.judged(durationS, flown.timing.periodS))

  /** Simulates the paused loop, which waits for every answer, so that delays do not matter. */
  def truth(episodes: Int): Either[String, Double] =
    val each   = named.pausedEpisodes(episodes)
    val paused = flown.paused.batch(threads.min(each)).fly(Worlds(of(atRest), Vector(DelayTable.none), each))
    Right(RunningStats.of(each)(objective.value(paused, _, durationS)).mean)

  def engine(links: Vector[LatencyDistribution]): Engine =
    batch.engine(candidate, shareEpisodes = false, links.map(DelayTable.of))

  def cellEpisodes(links: Vector[LatencyDistribution]): Int = effort(engine(links)).cellEpisodes

  def tallies(cells: BudgetCells): Either[String, Vector[RunningStats]] =
    val worlds   = Worlds(candidate, cells.links.map(DelayTable.of), cells.episodes)
    val outcomes = batch.fly(worlds, cells.onProgress(_), cells.isCancelled)
    Either.cond(
      outcomes.flown == worlds.size,
      Vector.tabulate(cells.links.size): link =>
        RunningStats.of(cells.episodes): episode =>
          objective.value(outcomes, link * cells.episodes + episode, durationS),
      BudgetSubject.Stopped
    )

  /** The worlds of cells that are simulated together: all links share the episodes, and the links follow each
    * other.
    */
  private final class Worlds(candidate: TeamCandidate, links: Vector[DelayTable], each: Int)
      extends TeamWorlds:
    private val tables                       = links.toArray
    private val keys                         = Array.tabulate(each)(WorldRandom.key(seed, 0, _))
    def size: Int                            = tables.length * each
    def key(world: Int): Int                 = keys(world % each)
    def link(world: Int): DelayTable         = tables(world / each)
    def candidate(world: Int): TeamCandidate = candidate
