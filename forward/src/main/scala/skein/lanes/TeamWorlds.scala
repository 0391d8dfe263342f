package skein.lanes

import skein.forward.Engagement
import skein.scenario.{Quantity, Reduction}

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

/** A number that a flight comes to.
  *
  * @param reduction of the quantity's values, one a period
  * @param fromS counted from here on
  */
final case class Judged(quantity: Quantity, reduction: Reduction | OfMoment, fromS: Double):
  private[lanes] def counts(timeS: Double): Boolean = Judged.counts(timeS, fromS)

  /** What values come to that count, with their times; no number where nothing counted. */
  private[lanes] def of(values: IndexedSeq[(Double, Double)]): Double = reduction match
    case OfMoment.FirstWithin(limit) =>
      values.collectFirst { case (timeS, value) if value <= limit => timeS }.getOrElse(
        Double.PositiveInfinity
      )
    case _ if values.isEmpty  => Double.NaN
    case OfMoment.Newest      => values.last._2
    case reduction: Reduction => reduction.of(values.map(_._2))

object Judged:
  private[lanes] def counts(timeS: Double, fromS: Double): Boolean = timeS > afterS(fromS)

  /** Times may be known as Floats alone, and the shortest period is a millisecond. */
  private[lanes] def afterS(fromS: Double): Double = fromS - 3e-4

/** What the values of a quantity come to, where it is told of one moment. */
enum OfMoment:
  /** When it first was at most this, s; infinite if it never was. */
  case FirstWithin(limit: Double)

  /** The last value. */
  case Newest

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
