package skein.optimise

import skein.forward.Delays
import skein.lanes.{DuelBatch, DuelNumber, DuelWorlds, Engine}
import skein.policy.{HeadingPolicy, PolicyFamily, Role}

/** Evaluates a family's candidates against one opponent in [[DuelBatch]].
  *
  * @param role of the candidates
  * @param opponent of the other role
  * @param seed of the delays
  * @param shareEpisodes see [[WorldsEvaluator]]
  */
final class DuelEvaluator(
    batch: DuelBatch,
    durationS: Double,
    family: PolicyFamily,
    role: Role,
    opponent: HeadingPolicy,
    link: Delays,
    objective: Objective,
    seed: Long,
    shareEpisodes: Boolean = true
) extends WorldsEvaluator(link, seed, shareEpisodes):

  protected def engine: Engine =
    val policy = family.defaultPolicy
    batch.engine(pursuer(policy), evader(policy), shareEpisodes, Seq(link))

  protected def flown(
      candidates: Vector[Vector[Double]],
      keys: Array[Int],
      isCancelled: () => Boolean
  ): Option[Int => Double] =
    val worlds   = Duels(candidates.map(family.policy).toArray, keys)
    val outcomes = batch.fly(worlds, objective.captureRadiusM, isCancelled = isCancelled)
    Option.when(outcomes.flown == worlds.size)(objective.value(outcomes, _, role, durationS))

  private def pursuer(candidate: HeadingPolicy): HeadingPolicy =
    if role == Role.Pursuer then candidate else opponent
  private def evader(candidate: HeadingPolicy): HeadingPolicy =
    if role == Role.Evader then candidate else opponent

  private final class Duels(policies: Array[HeadingPolicy], keys: Array[Int])
      extends EachOf(policies, keys),
        DuelWorlds:
    override def asked: Set[DuelNumber]    = objective.asked(role)
    def pursuer(world: Int): HeadingPolicy = DuelEvaluator.this.pursuer(of(world))
    def evader(world: Int): HeadingPolicy  = DuelEvaluator.this.evader(of(world))
