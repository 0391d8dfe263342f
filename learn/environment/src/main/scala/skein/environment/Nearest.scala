package skein.environment

import skein.scenario.{Positions, Quantity}

/** Horizontal distance of a vehicle from the nearest of some others, m. */
private final class Nearest(self: Int, others: Array[Int]) extends Quantity:
  def of(positions: Positions): Double =
    var least = positions.distanceM(self, others(0))
    var i     = 1
    while i < others.length do
      least = least.min(positions.distanceM(self, others(i)))
      i += 1
    least
