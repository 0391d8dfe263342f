package skein.scenario

import skein.policy.Racetrack

/** Root mean square deviation of the pursuers from a ring around the evader, m. The evader is the first
  * vehicle.
  */
final case class OffRing(ringM: Double) extends Quantity:
  def of(positions: Positions): Double =
    var sum     = 0.0
    var pursuer = 1
    while pursuer < positions.count do
      val off = positions.distanceM(0, pursuer) - ringM
      sum += off * off
      pursuer += 1
    math.sqrt(sum / (positions.count - 1))

/** The largest angle between neighbouring vehicles, seen from the first vehicle, degrees. */
case object WidestGap extends Quantity:
  def of(positions: Positions): Double =
    val bearings = new Array[Double](positions.count - 1)
    var i        = 0
    while i < bearings.length do
      val (north, east) =
        (positions.northM(i + 1) - positions.northM(0), positions.eastM(i + 1) - positions.eastM(0))
      bearings(i) = StrictMath.atan2(east, north)
      i += 1
    ascend(bearings)
    var widest = bearings(0) + 2 * math.Pi - bearings(bearings.length - 1)
    i = 1
    while i < bearings.length do
      widest = widest.max(bearings(i) - bearings(i - 1))
      i += 1
    widest.toDegrees

  /** Sorts by exchanging neighbours. The sequence of comparisons does not depend on the values, so that SIMD
    * can execute it.
    */
  private def ascend(numbers: Array[Double]): Unit =
    var last = numbers.length - 1
    while last > 0 do
      var i = 0
      while i < last do
        val (one, other) = (numbers(i), numbers(i + 1))
        numbers(i) = one.min(other)
        numbers(i + 1) = one.max(other)
        i += 1
      last -= 1

/** Horizontal separation of two vehicles, m. */
final case class Apart(one: Int, other: Int) extends Quantity:
  def of(positions: Positions): Double = positions.distanceM(one, other)

/** Horizontal distance of a vehicle from a place, m. */
final case class FromPlace(vehicle: Int, northM: Double, eastM: Double) extends Quantity:
  def of(positions: Positions): Double = positions.distanceM(vehicle, northM, eastM)

/** Smallest horizontal separation between any two vehicles, m. */
case object Separation extends Quantity:
  def of(positions: Positions): Double =
    var least = Double.PositiveInfinity
    var one   = 1
    while one < positions.count do
      var other = 0
      while other < one do
        least = least.min(positions.distanceM(one, other))
        other += 1
      one += 1
    least

/** Root mean square deviation of the followers from their slots, m. The slots are in the frame along the
  * circuit at the leader, the first vehicle.
  *
  * @param aheadM distance of each follower's slot ahead of the leader
  * @param rightM distance of each follower's slot to the right of the leader
  */
final case class OffSlots(circuit: Racetrack, aheadM: IArray[Double], rightM: IArray[Double])
    extends Quantity:
  def of(positions: Positions): Double =
    val heading    = headingRad(positions)
    val (cos, sin) = (StrictMath.cos(heading), StrictMath.sin(heading))
    var sum        = 0.0
    var i          = 0
    while i < aheadM.length do
      val off = offM(positions, i, cos, sin)
      sum += off * off
      i += 1
    math.sqrt(sum / aheadM.length)

  private[scenario] def headingRad(positions: Positions): Double =
    circuit.headingRad(circuit.nearest(positions.northM(0), positions.eastM(0)))

  /** Deviation of a follower from its slot, m.
    *
    * @param cos cosine of the heading
    */
  private[scenario] def offM(positions: Positions, follower: Int, cos: Double, sin: Double): Double =
    positions.distanceM(
      follower + 1,
      positions.northM(0) + aheadM(follower) * cos - rightM(follower) * sin,
      positions.eastM(0) + aheadM(follower) * sin + rightM(follower) * cos
    )

/** The largest deviation of a follower from its slot, m. */
final case class FarthestOffSlot(slots: OffSlots) extends Quantity:
  def of(positions: Positions): Double =
    val heading    = slots.headingRad(positions)
    val (cos, sin) = (StrictMath.cos(heading), StrictMath.sin(heading))
    var most       = 0.0
    var i          = 0
    while i < slots.aheadM.length do
      most = most.max(slots.offM(positions, i, cos, sin))
      i += 1
    most
