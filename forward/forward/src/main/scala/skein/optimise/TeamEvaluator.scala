package skein.optimise

import skein.forward.Delays
import skein.lanes.{TeamBatch, TeamCandidate, TeamWorlds}
import skein.simd.WorldRandom

/** Evaluates a team's candidates by simulation in a [[TeamBatch]].
  *
  * @param candidate creates a candidate, with the objective's scores, from parameters; a pure function
  * @param seed seed of the delays, which are equal for all candidates
  * @param shareEpisodes see [[skein.lanes.Worlds.shareEpisodes]]; faster for many candidates, slower for a
  *   single one
  * @param usual parameters of a typical candidate, which determine how many candidates run together if they
  *   share episodes
  */
final class TeamEvaluator(
    batch: TeamBatch,
    candidate: Vector[Double] => TeamCandidate,
    link: Delays,
    objective: Objective,
    seed: Long,
    shareEpisodes: Boolean = true,
    usual: Vector[Double] = Vector.empty
) extends ValueEvaluator:

  override def sideBySide: Int =
    if shareEpisodes then batch.engine(candidate(usual), shareEpisodes, Seq(link)).sideBySide else 1

  def valuesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[Array[Double]]] =
    val keys     = episodes.map(WorldRandom.key(seed, 0, _)).toArray
    val teams    = candidates.map(candidate).toArray
    val worlds   = Worlds(teams, keys)
    val outcomes = batch.fly(worlds, isCancelled = isCancelled)
    Option.when(outcomes.flown == worlds.size):
      Vector.tabulate(teams.length): number =>
        val durationS = teams(number).engagement.durationS
        Array.tabulate(keys.length): episode =>
          objective.value(outcomes, number * keys.length + episode, durationS)

  /** The worlds of all candidates: for each candidate, its episodes in order. */
  private final class Worlds(teams: Array[TeamCandidate], keys: Array[Int]) extends TeamWorlds:
    def size: Int                            = teams.length * keys.length
    override def shareEpisodes: Boolean      = TeamEvaluator.this.shareEpisodes
    override def episodesOfEach: Int         = keys.length
    def key(world: Int): Int                 = keys(world % keys.length)
    def link(world: Int): Delays             = TeamEvaluator.this.link
    def candidate(world: Int): TeamCandidate = teams(world / keys.length)
