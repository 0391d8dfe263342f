package skein.lanes.score

import skein.scenario.{Quantity, Reduction}

/** A score of a flight: a quantity, reduced over time.
  *
  * @param reduction how the quantity's values, one per period, become one value
  * @param fromS time of the first value that is used
  * @param everyS time between two values, s; only [[Reduction.TimePositive]] needs it
  */
final case class Judged(
    quantity: Quantity,
    reduction: Reduction | OfMoment,
    fromS: Double,
    everyS: Double = 0
):
  private[lanes] def counts(timeS: Double): Boolean = Judged.counts(timeS, fromS)

object Judged:
  private[lanes] def counts(timeS: Double, fromS: Double): Boolean = timeS > afterS(fromS)

  /** Moves a time slightly earlier, because times may be rounded to floats. The shortest period is a
    * millisecond.
    */
  private[lanes] def afterS(fromS: Double): Double = fromS - 3e-4

/** Control effort of a flight: the sum of all changes of a vehicle's commanded heading, each by the shorter
  * way, rad. SIMD computes it for duels, at a twentieth of the cost of a flight.
  */
final case class Effort(vehicle: Int)

/** Reductions that select one moment of a quantity's values. */
enum OfMoment:
  /** First time at which the value was at most `limit`, s; infinite if it never was. */
  case FirstWithin(limit: Double)

  case Newest
