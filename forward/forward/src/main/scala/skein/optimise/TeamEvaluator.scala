package skein.optimise

import skein.forward.Delays
import skein.lanes.{Engine, TeamBatch, TeamCandidate, TeamWorlds}

/** Simulates a team's candidates in [[TeamBatch]].
  *
  * @param candidate made from parameters; a pure function
  * @param weights of the judged numbers, in their order: the weighted sum is the objective
  * @param seed of the delays
  * @param shareEpisodes see [[WorldsEvaluator]]
  * @param usual parameters of a typical candidate, from which the number that run side by side is derived, if
  *   they share episodes
  */
final class TeamEvaluator(
    batch: TeamBatch,
    candidate: Vector[Double] => TeamCandidate,
    link: Delays,
    weights: Vector[Double],
    seed: Long,
    shareEpisodes: Boolean = true,
    usual: Vector[Double] = Vector.empty
) extends WorldsEvaluator(link, seed, shareEpisodes):

  protected def engine: Engine = batch.engine(candidate(usual), shareEpisodes, Seq(link))

  protected def flown(
      candidates: Vector[Vector[Double]],
      keys: Array[Int],
      isCancelled: () => Boolean
  ): Option[Int => Double] =
    val worlds   = Teams(candidates.map(candidate).toArray, keys)
    val outcomes = batch.fly(worlds, isCancelled = isCancelled)
    Option.when(outcomes.flown == worlds.size)(outcomes.sum(weights, _))

  private final class Teams(teams: Array[TeamCandidate], keys: Array[Int])
      extends EachOf(teams, keys),
        TeamWorlds:
    def candidate(world: Int): TeamCandidate = of(world)
