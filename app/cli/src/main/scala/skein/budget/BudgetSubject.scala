package skein.budget

import skein.forward.DelayTable
import skein.lanes.{DuelNumber, DuelWorlds, Engine}
import skein.optimise.{Objective, RunningStats}
import skein.policy.{HeadingPolicy, Role}
import skein.search.{Conditions, Effort}
import skein.settings.PolicyFile
import skein.signal.LatencyDistribution
import skein.simd.WorldRandom

/** The subject of a budget: simulated over links, it yields a number.
  *
  * @param loop by its name
  * @param vehicles the vehicle model, in a line
  * @param label of the policy, or of the scenario
  * @param formula of the number, in `unit`, which may be empty
  */
trait BudgetSubject(
    val loop: String,
    val periodMs: Double,
    val durationS: Double,
    val vehicles: String,
    val label: String,
    val formula: String,
    val unit: String
):
  /** The number in a world that waits for the controller; Left states why there is none. */
  def truth: Either[String, Double]

  def engine(links: Vector[LatencyDistribution]): Engine

  /** Episodes of a cell that are simulated within seconds. */
  def cellEpisodes(links: Vector[LatencyDistribution]): Int

  /** Number of rows of a map that one call simulates. */
  def rowsTogether: Int = 1

  /** The statistics of each cell; all cells use equal random numbers.
    *
    * @return Left states why there are none
    */
  def tallies(cells: BudgetCells): Either[String, Vector[RunningStats]]

/** Cells of a map that are to be simulated.
  *
  * @param links by their round trips
  * @param episodes of each
  * @param onProgress called with the number of episodes done
  */
final case class BudgetCells(
    links: Vector[LatencyDistribution],
    episodes: Int,
    onProgress: Long => Unit = _ => (),
    isCancelled: () => Boolean = () => false
):
  /** The statistics of each cell, after its [[CellWorlds]] were simulated.
    *
    * @param flown number of worlds that were simulated
    * @param value of a world
    * @return Left states that it was stopped before
    */
  def tallies(flown: Int)(value: Int => Double): Either[String, Vector[RunningStats]] = Either.cond(
    flown == links.size * episodes,
    Vector.tabulate(links.size)(link =>
      RunningStats.of(episodes)(episode => value(link * episodes + episode))
    ),
    BudgetSubject.Stopped
  )

/** The worlds of cells that are simulated together: every link has the same episodes, and the links follow
  * each other.
  */
abstract class CellWorlds(links: Vector[DelayTable], each: Int, seed: Long):
  private val tables               = links.toArray
  private val keys                 = Array.tabulate(each)(WorldRandom.key(seed, 0, _))
  def size: Int                    = tables.length * each
  def key(world: Int): Int         = keys(world % each)
  def link(world: Int): DelayTable = tables(world / each)

object BudgetSubject:
  val Stopped = "stopped before the map was whole"

/** A policy's result in the paper's duel, as a budget's subject. */
final class DuelSubject(
    named: Conditions,
    flown: Conditions.Resolved,
    policy: PolicyFile,
    opponent: PolicyFile,
    objective: Objective,
    seed: Long,
    threads: Int
) extends BudgetSubject(
      named.loopText,
      named.periodMs,
      named.durationS,
      flown.vehicle.description,
      policy.label,
      objective.formula,
      objective.unit
    ):
  private val batch             = flown.batch(threads)
  private val (pursuer, evader) =
    if policy.role == Role.Pursuer then (policy.policy, opponent.policy) else (opponent.policy, policy.policy)

  /** Simulates the paused loop, which waits for every answer, so that neither delay nor chance matters. */
  def truth: Either[String, Double] =
    val paused = flown.paused.batch(1).fly(Worlds(Vector(DelayTable.none), 1), objective.captureRadiusM)
    Right(objective.value(paused, 0, policy.role, durationS))

  def cellEpisodes(links: Vector[LatencyDistribution]): Int =
    val alone = engine(links)
    Effort.of(alone, alone, flown.vehicle, flown.sees).cellEpisodes

  def engine(links: Vector[LatencyDistribution]): Engine =
    batch.engine(pursuer, evader, shareEpisodes = false, links.map(DelayTable.of))

  def tallies(cells: BudgetCells): Either[String, Vector[RunningStats]] =
    val outcomes = batch.fly(
      Worlds(cells.links.map(DelayTable.of), cells.episodes),
      objective.captureRadiusM,
      cells.onProgress(_),
      cells.isCancelled
    )
    cells.tallies(outcomes.flown)(objective.value(outcomes, _, policy.role, durationS))

  private final class Worlds(links: Vector[DelayTable], each: Int)
      extends CellWorlds(links, each, seed),
        DuelWorlds:
    override def asked: Set[DuelNumber]    = objective.asked(policy.role)
    def pursuer(world: Int): HeadingPolicy = DuelSubject.this.pursuer
    def evader(world: Int): HeadingPolicy  = DuelSubject.this.evader
