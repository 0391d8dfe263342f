package skein.optimise

import skein.forward.Delays
import skein.lanes.{DuelBatch, DuelNumber, DuelWorlds}
import skein.policy.{HeadingPolicy, PolicyFamily, Role}
import skein.simd.WorldRandom

/** Evaluates a family's candidates against one opponent in [[DuelBatch]].
  *
  * @param role of the candidates
  * @param opponent of the other role
  * @param seed of the delays
  * @param shareEpisodes see [[DuelWorlds.shareEpisodes]]: for many candidates; a single one runs faster
  *   without
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
) extends ValueEvaluator:

  override def sideBySide: Int =
    val policy = family.defaultPolicy
    if shareEpisodes then batch.engine(pursuer(policy), evader(policy), shareEpisodes, Seq(link)).sideBySide
    else 1

  def valuesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[Array[Double]]] =
    val policies = candidates.map(family.policy).toArray
    val keys     = episodes.map(WorldRandom.key(seed, 0, _)).toArray
    val worlds   = Worlds(policies, keys)
    val outcomes = batch.fly(worlds, objective.captureRadiusM, isCancelled = isCancelled)
    Option.when(outcomes.flown == worlds.size):
      Vector.tabulate(policies.length): candidate =>
        Array.tabulate(keys.length): episode =>
          objective.value(outcomes, candidate * keys.length + episode, role, durationS)

  private def pursuer(candidate: HeadingPolicy): HeadingPolicy =
    if role == Role.Pursuer then candidate else opponent
  private def evader(candidate: HeadingPolicy): HeadingPolicy =
    if role == Role.Evader then candidate else opponent

  /** Keys do not depend on the candidate: all candidates have equal delays. */
  private final class Worlds(policies: Array[HeadingPolicy], keys: Array[Int]) extends DuelWorlds:
    def size: Int                          = policies.length * keys.length
    override def shareEpisodes: Boolean    = DuelEvaluator.this.shareEpisodes
    override def episodesOfEach: Int       = keys.length
    override def asked: Set[DuelNumber]    = objective.asked(role)
    def key(world: Int): Int               = keys(world % keys.length)
    def link(world: Int): Delays           = DuelEvaluator.this.link
    def pursuer(world: Int): HeadingPolicy = DuelEvaluator.this.pursuer(policies(world / keys.length))
    def evader(world: Int): HeadingPolicy  = DuelEvaluator.this.evader(policies(world / keys.length))
