package skein.lanes.score

import skein.scenario.{Quantity, Reduction}

/** A number that is computed of a flight.
  *
  * @param reduction of the quantity's values, one a period
  * @param fromS time of the first value that counts
  */
final case class Judged(quantity: Quantity, reduction: Reduction | OfMoment, fromS: Double):
  private[lanes] def counts(timeS: Double): Boolean = Judged.counts(timeS, fromS)

  /** Reduces those of the timed values that count; NaN where none counts. */
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

  /** Moves a time to just before itself: times may be stored as floats, and the shortest period is a
    * millisecond.
    */
  private[lanes] def afterS(fromS: Double): Double = fromS - 3e-4

/** Reductions of a quantity's values to one moment. */
enum OfMoment:
  /** First time at which the value was at most this, s; infinite if it never was. */
  case FirstWithin(limit: Double)

  case Newest
