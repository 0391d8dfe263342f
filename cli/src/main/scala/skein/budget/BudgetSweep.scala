package skein.budget

import skein.forward.DelayTable
import skein.lanes.DuelWorlds
import skein.optimise.{LatencyBudget, Objective, Tally}
import skein.policy.{Policy, Role}
import skein.search.{Conditions, Effort}
import skein.settings.PolicyFile
import skein.signal.LatencyDistribution
import skein.simd.WorldRandom

/** Flies a policy over links of many latencies and jitters, and once over none while the world waits.
  *
  * @param flown
  *   loop, period, vehicles
  * @param policy
  *   that is judged
  * @param asked
  *   episodes of each cell, where they were asked for
  */
final class BudgetSweep(
    flown: Conditions.Resolved,
    policy: PolicyFile,
    opponent: PolicyFile,
    objective: Objective,
    axes: BudgetAxes,
    asked: Option[Int],
    seed: Long,
    threads: Int
):
  private val durationS         = flown.duel.durationS
  private val batch             = flown.batch(threads)
  private val (pursuer, evader) =
    if policy.role == Role.Pursuer then (policy.policy, opponent.policy) else (opponent.policy, policy.policy)

  /** The paused loop waits for every answer, so that no delay, and no chance, enters. */
  def truth: Double =
    val paused = flown.paused.batch(1).fly(Worlds(Vector(DelayTable.none), 1), objective.captureRadiusM)
    objective.value(paused, 0, policy.role, durationS)

  /** Of each cell: as many as were asked for, or as the engine flies in seconds. */
  lazy val episodes: Int = asked.getOrElse:
    val isFast = batch.fliesByLanes(pursuer, evader, shareEpisodes = false, links.flatten.flatten)
    Effort.of(isFast, isFast, flown.vehicle).cellEpisodes

  /** Of the map's cells, row by row. */
  private val links: Vector[Vector[Option[DelayTable]]] =
    axes.jittersMs.map(jitter => axes.meansMs.map(LatencyBudget.link(_, jitter).map(DelayTable.of)))

  /** What flies the cells, in a line for the user. */
  def engine: String = batch.engine(pursuer, evader, shareEpisodes = false, links.flatten.flatten)

  /** Over a link with these round trips. */
  def over(roundTrip: LatencyDistribution): Tally =
    tallies(Vector(DelayTable.of(roundTrip)), _ => (), () => false).get.head

  /** The whole map, row by row.
    *
    * @param onProgress
    *   told how many episodes are flown
    * @return
    *   none if it was cancelled
    */
  def map(onProgress: Long => Unit, isCancelled: () => Boolean): Option[LatencyBudget] =
    val truthNow = truth
    val rows     = links.scanLeft((0L, Option(Vector.empty[Option[Tally]]))):
      case ((before, Some(_)), row) =>
        val known = row.flatten
        val own   = tallies(known, done => onProgress(before + done), isCancelled)
        (before + known.size.toLong * episodes, own.map(spread(row, _)))
      case (cancelled, _) => cancelled
    .tail.map(_._2)
    Option.when(rows.forall(_.isDefined))(LatencyBudget(axes.meansMs, axes.jittersMs, rows.flatten, truthNow))

  /** Episodes of the map. */
  def expected: Long = links.flatten.flatten.size.toLong * episodes

  private def spread(row: Vector[Option[DelayTable]], tallies: Vector[Tally]): Vector[Option[Tally]] =
    val next = tallies.iterator
    row.map(_.map(_ => next.next()))

  private def tallies(
      links: Vector[DelayTable],
      onProgress: Long => Unit,
      isCancelled: () => Boolean
  ): Option[Vector[Tally]] =
    val worlds   = Worlds(links, episodes)
    val outcomes = batch.fly(worlds, objective.captureRadiusM, done => onProgress(done), isCancelled)
    Option.when(outcomes.flown == worlds.size):
      Vector.tabulate(links.size): link =>
        Tally.of(episodes)(episode =>
          objective.value(outcomes, link * episodes + episode, policy.role, durationS)
        )

  /** All links meet the same random numbers. */
  private final class Worlds(links: Vector[DelayTable], each: Int) extends DuelWorlds:
    private val tables = links.toArray
    private val keys   = Array.tabulate(each)(WorldRandom.key(seed, 0, _))

    def size: Int                    = tables.length * each
    def key(world: Int): Int         = keys(world % each)
    def link(world: Int): DelayTable = tables(world / each)
    def pursuer(world: Int): Policy  = BudgetSweep.this.pursuer
    def evader(world: Int): Policy   = BudgetSweep.this.evader

/** Where the cells lie: round trips' means and jitters, ms, from 0 in even steps. */
final case class BudgetAxes(meansMs: Vector[Double], jittersMs: Vector[Double])

object BudgetAxes:
  /** `count` values each, from 0 up to the most, which is left out. */
  def of(mostMeanMs: Double, means: Int, mostJitterMs: Double, jitters: Int): BudgetAxes =
    BudgetAxes(
      Vector.tabulate(means)(_ * mostMeanMs / means),
      Vector.tabulate(jitters)(_ * mostJitterMs / jitters)
    )
