package skein.optimise

import skein.forward.Delays
import skein.lanes.{Engine, Worlds}
import skein.simd.WorldRandom

/** Evaluates candidates in the worlds of one call of a batch: each of them in all episodes.
  *
  * @param seed of the delays, which are equal for all candidates
  * @param shareEpisodes see [[Worlds.shareEpisodes]]: for many candidates; a single one runs faster without
  */
private[optimise] abstract class WorldsEvaluator(link: Delays, seed: Long, shareEpisodes: Boolean)
    extends ValueEvaluator:

  /** The engine that simulates candidates with usual parameters. */
  protected def engine: Engine

  /** Simulates all worlds.
    *
    * @param keys of the episodes
    * @return the objective's value by world; None if it was cancelled
    */
  protected def flown(
      candidates: Vector[Vector[Double]],
      keys: Array[Int],
      isCancelled: () => Boolean
  ): Option[Int => Double]

  override def sideBySide: Int = if shareEpisodes then engine.sideBySide else 1

  final def valuesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[Array[Double]]] =
    val keys = episodes.map(WorldRandom.key(seed, 0, _)).toArray
    flown(candidates, keys, isCancelled).map: value =>
      Vector.tabulate(candidates.size): candidate =>
        Array.tabulate(keys.length)(episode => value(candidate * keys.length + episode))

  /** The worlds of all candidates, by candidate and episode. */
  protected abstract class EachOf[C](candidates: Array[C], keys: Array[Int]) extends Worlds:
    final def size: Int                       = candidates.length * keys.length
    final override def shareEpisodes: Boolean = WorldsEvaluator.this.shareEpisodes
    final override def episodesOfEach: Int    = keys.length
    final def key(world: Int): Int            = keys(world % keys.length)
    final def link(world: Int): Delays        = WorldsEvaluator.this.link
    protected final def of(world: Int): C     = candidates(world / keys.length)
