package skein.environment

import skein.scenario.{Positions, Quantity}

/** Horizontal distance of a vehicle from the nearest of some others, m. */
private final class Nearest(self: Int, others: Array[Int]) extends Quantity:
  def of(positions: Positions): Double =
    var least = between(positions, others(0))
    var i     = 1
    while i < others.length do
      least = least.min(between(positions, others(i)))
      i += 1
    least

  // In one order, so that SIMD computes what two learners are apart once.
  private def between(positions: Positions, other: Int) =
    if self < other then positions.distanceM(self, other) else positions.distanceM(other, self)
