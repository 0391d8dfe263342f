package skein.lanes.score

import skein.scenario.{Quantity, Reduction}

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
