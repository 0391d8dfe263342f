package skein.policy

import skein.policy.Avoidance.Velocity
import skein.policy.HalfPlanes.*

/** Half planes of velocities v, m/s: v·normal ≥ least. A normal may have any length. Filled in by [[put]].
  *
  * Both questions are answered by incremental linear programming, in the plane and in three dimensions, without the
  * shuffling (de Berg, Cheong, van Kreveld, Overmars: ''Computational Geometry'', 3rd ed., 2008, chapter 4; van den Berg
  * and others as in [[Avoidance]], section 5): rounds of a fixed number, n² and n³ of them over six.
  */
private[policy] final class HalfPlanes(val count: Int):
  private val normalNorth = new Array[Double](count)
  private val normalEast  = new Array[Double](count)
  private val least       = new Array[Double](count)

  def put(number: Int, normalNorth: Double, normalEast: Double, least: Double): Unit =
    this.normalNorth(number) = normalNorth
    this.normalEast(number) = normalEast
    this.least(number) = least

  /** By how far a velocity breaks one, of its normal's length. */
  def broken(number: Int, of: Velocity): Double =
    least(number) - (normalNorth(number) * of.north + normalEast(number) * of.east)

  /** The velocity nearest to one that is wanted, within all half planes and no faster than allowed.
    *
    * One after the other is taken in. Where the velocity so far breaks it, the nearest one that is within this and those
    * before lies on its edge.
    */
  def nearest(wanted: Velocity, mostMps: Double): Nearest =
    var found   = wanted.limited(mostMps)
    var missing = 0.0
    for i <- 0 until count do
      if broken(i, found) > 0 then
        // The edge: foot + t (−east, north), for low ≤ t ≤ high.
        val north     = normalNorth(i)
        val east      = normalEast(i)
        val square    = north * north + east * east
        val footNorth = north * (least(i) / square)
        val footEast  = east * (least(i) / square)
        val inside    = mostMps * mostMps * square - least(i) * least(i)
        val half      = math.sqrt(inside.max(0)) / square
        var low       = -half
        var high      = half
        for k <- 0 until i do
          val rise  = normalEast(k) * north - normalNorth(k) * east
          val lacks = least(k) - (normalNorth(k) * footNorth + normalEast(k) * footEast)
          // Along an edge beside it, the other half plane holds everywhere or nowhere.
          val from = lacks / (rise + Tiny)
          if rise >= 0 then low = low.max(from) else high = high.min(from)
        missing = missing.max(low - high).max(-inside)
        val along = ((wanted.east - footEast) * north - (wanted.north - footNorth) * east) / square
        val at    = along.max(low).min(high)
        found = Velocity(footNorth - at * east, footEast + at * north)
    Nearest(found, missing)

  /** The velocity that breaks the worst of them least, and of those that do so about equally the one nearest to that
    * wanted: the minimum of the worst violation + |v − wanted|² / (2 [[Weight]]). Normals have a length of 1, or of 0.
    *
    * Where the velocity so far breaks the next more than all before, the next is the worst one in the minimum.
    */
  def leastBroken(wanted: Velocity, mostMps: Double): Velocity =
    var found = wanted
    var worst = Double.NegativeInfinity
    for i <- 0 until count do
      if broken(i, found) > worst then
        found = whereWorst(i).nearest(
          Velocity(wanted.north + Weight * normalNorth(i), wanted.east + Weight * normalEast(i)),
          mostMps
        ).velocity
        worst = broken(i, found)
    found

  /** Where none of those before is broken more than one. */
  private def whereWorst(number: Int): HalfPlanes =
    val planes = HalfPlanes(number)
    for k <- 0 until number do
      planes.put(
        k,
        normalNorth(k) - normalNorth(number),
        normalEast(k) - normalEast(number),
        least(k) - least(number)
      )
    planes

private[policy] object HalfPlanes:

  /** What is nearest to a velocity that is wanted.
    *
    * @param missing
    *   0 if it is within all half planes; more if there is no such velocity
    */
  final case class Nearest(velocity: Velocity, missing: Double)

  /** A least that, with a normal of 0, bounds nothing. */
  val Always: Double = -1e6

  /** m/s. A violation counts so much more than the distance from what is wanted that only edges within 10⁻³ rad of one
    * another are not told apart.
    */
  private val Weight = 1e4

  /** In a sum with it nothing but 0 changes. */
  private val Tiny = 1e-30
