package skein.lanes

import skein.forward.Engagement
import skein.lanes.score.{Effort, Judged}
import skein.scenario.OwnEnd

/** The worlds of one call of [[TeamBatch]]: a candidate and a link each. */
trait TeamWorlds extends Worlds:
  /** The candidate of a world: one object for all its worlds. */
  def candidate(world: Int): TeamCandidate

/** A team as a candidate of a search.
  *
  * @param judged the values to compute; equal in count and form for every candidate, except for parameters of
  *   the quantities
  * @param areAtOnePace whether all candidates of a call have these speeds and first headings; then two
  *   opponents that command headings are simulated fastest
  */
final class TeamCandidate(
    val engagement: Engagement,
    val judged: Vector[Judged | Effort],
    val areAtOnePace: Boolean = true
):
  private[skein] val quantities: Vector[Judged] = judged.collect { case each: Judged => each }

  /** The scenario's own end, if the team flies a scenario that has one. */
  private[lanes] def ownEnd: Option[OwnEnd] = engagement.isOver.collect { case end: OwnEnd => end }

/** The results of each world.
  *
  * @param values values indexed by score, then by world; NaN where no value counted
  */
final class TeamOutcomes private[lanes] (val values: Vector[Array[Float]]):
  private var done = 0

  /** Number of simulated worlds: all, unless the call was cancelled. */
  def flown: Int = done

  private[lanes] def flown_=(worlds: Int): Unit = done = worlds

  private[lanes] def set(world: Int, came: Vector[Double]): Unit =
    for (value, number) <- came.zipWithIndex do values(number)(world) = value.toFloat
