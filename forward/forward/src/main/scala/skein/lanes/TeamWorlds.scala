package skein.lanes

import skein.forward.Engagement
import skein.lanes.score.Judged

/** The worlds of one call of [[TeamBatch]]: a candidate and a link each. */
trait TeamWorlds extends Worlds:
  /** The candidate of a world: one object for all its worlds. */
  def candidate(world: Int): TeamCandidate

/** A team as a candidate of a search.
  *
  * @param judged the numbers to compute; equal in count and form for every candidate, except for numbers in
  *   the quantities
  */
final class TeamCandidate(val engagement: Engagement, val judged: Vector[Judged])

/** The results of each world.
  *
  * @param values by judged number, then by world; NaN where no value counted
  */
final class TeamOutcomes private[lanes] (val values: Vector[Array[Float]]):
  private var done = 0

  /** Number of simulated worlds: all, unless the call was cancelled. */
  def flown: Int = done

  private[lanes] def flown_=(worlds: Int): Unit = done = worlds

  /** A weighted sum of a world's results.
    *
    * @param weights by judged number
    */
  def sum(weights: Vector[Double], world: Int): Double =
    weights.indices.map(number => weights(number) * values(number)(world)).sum

  private[lanes] def set(world: Int, came: Vector[Double]): Unit =
    for (value, number) <- came.zipWithIndex do values(number)(world) = value.toFloat
