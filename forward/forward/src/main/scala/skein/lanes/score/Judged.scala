package skein.lanes.score

import skein.scenario.{Quantity, Reduction}

/** A number that is computed of a flight.
  *
  * @param reduction of the quantity's values, one a period
  * @param fromS time of the first value that counts
  */
final case class Judged(quantity: Quantity, reduction: Reduction | OfMoment, fromS: Double):
  private[lanes] def counts(timeS: Double): Boolean = Judged.counts(timeS, fromS)

object Judged:
  private[lanes] def counts(timeS: Double, fromS: Double): Boolean = timeS > afterS(fromS)

  /** Moves a time to just before itself: times may be stored as floats, and the shortest period is a
    * millisecond.
    */
  private[lanes] def afterS(fromS: Double): Double = fromS - 3e-4

/** Control effort, a number of a flight: the sum of all changes of a vehicle's commanded heading, each by the
  * shorter way, rad. SIMD computes it of two that play against one another, where it costs a twentieth of a
  * flight.
  */
final case class Effort(vehicle: Int)

/** Reductions of a quantity's values to one moment. */
enum OfMoment:
  /** First time at which the value was at most this, s; infinite if it never was. */
  case FirstWithin(limit: Double)

  case Newest
