package skein.environment

import skein.scenario.{Positions, Quantity}
import skein.units.eachFrom

/** Distance of a vehicle from the nearest of some other vehicles, in the plane or in space, m. */
private final class Nearest(self: Int, others: Array[Int], inSpace: Boolean) extends Quantity:
  def of(positions: Positions): Double =
    var least = distanceM(positions, others(0))
    eachFrom(1, others.length): i =>
      least = least.min(distanceM(positions, others(i)))
    least

  private def distanceM(positions: Positions, other: Int) =
    val level = positions.distanceM(self, other)
    if inSpace then StrictMath.hypot(level, positions.downM(self) - positions.downM(other)) else level
