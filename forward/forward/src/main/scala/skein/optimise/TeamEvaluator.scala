package skein.optimise

import skein.forward.Delays
import skein.lanes.{TeamBatch, TeamCandidate, TeamWorlds}
import skein.simd.{LaneFunction, WorldRandom}

/** Simulates a team's candidates in [[TeamBatch]].
  *
  * @param candidate made from parameters; a pure function
  * @param weights of the judged numbers, in their order: the weighted sum is the objective
  * @param seed of the delays
  * @param shareEpisodes whether they share episodes, each by one timetable: for many candidates; a single one
  *   runs faster without
  * @param usual parameters of a typical candidate, from which the number that run side by side is derived
  */
final class TeamEvaluator(
    batch: TeamBatch,
    candidate: Vector[Double] => TeamCandidate,
    link: Delays,
    weights: Vector[Double],
    seed: Long,
    shareEpisodes: Boolean = true,
    usual: Option[Vector[Double]] = None
) extends ValueEvaluator:

  override def sideBySide: Int =
    if shareEpisodes then
      usual.fold(LaneFunction.COUNT)(each =>
        batch.engine(candidate(each), shareEpisodes, Seq(link)).sideBySide
      )
    else 1

  def valuesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[Array[Double]]] =
    val teams    = candidates.map(candidate)
    val keys     = episodes.map(WorldRandom.key(seed, 0, _)).toArray
    val worlds   = Worlds(teams, keys)
    val outcomes = batch.fly(worlds, isCancelled = isCancelled)
    Option.when(outcomes.flown == worlds.size):
      Vector.tabulate(teams.size): number =>
        Array.tabulate(keys.length): episode =>
          val world = number * keys.length + episode
          outcomes.sum(weights, world)

  private final class Worlds(teams: Vector[TeamCandidate], keys: Array[Int]) extends TeamWorlds:
    def size: Int                            = teams.size * keys.length
    override def shareEpisodes: Boolean      = TeamEvaluator.this.shareEpisodes
    override def episodesOfEach: Int         = keys.length
    def key(world: Int): Int                 = keys(world % keys.length)
    def link(world: Int): Delays             = TeamEvaluator.this.link
    def candidate(world: Int): TeamCandidate = teams(world / keys.length)
