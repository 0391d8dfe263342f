package skein.lanes

import skein.forward.Engagement
import skein.lanes.score.Judged

/** The worlds of one call of [[TeamBatch]]. */
trait TeamWorlds extends Worlds:
  /** The same object for all worlds of a candidate. */
  def candidate(world: Int): TeamCandidate

/** A team as one candidate of a search has it.
  *
  * @param judged what its flights are judged by; as many for every candidate, and alike but for numbers in
  *   the quantities
  */
final class TeamCandidate(val engagement: Engagement, val judged: Vector[Judged])

/** What each world came to.
  *
  * @param values by what is judged, then by world; no number where nothing counted
  */
final class TeamOutcomes private[lanes] (val values: Vector[Array[Float]]):
  private var done = 0

  /** How many worlds were flown: all, unless the call was cancelled. */
  def flown: Int = done

  private[lanes] def flown_=(worlds: Int): Unit = done = worlds

  /** A sum of a world's numbers.
    *
    * @param weights by what is judged
    */
  def sum(weights: Vector[Double], world: Int): Double =
    weights.indices.map(number => weights(number) * values(number)(world)).sum

  private[lanes] def set(world: Int, came: Vector[Double]): Unit =
    for (value, number) <- came.zipWithIndex do values(number)(world) = value.toFloat
