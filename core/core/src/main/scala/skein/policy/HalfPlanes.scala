package skein.policy

import skein.policy.HalfPlanes.*

/** Half planes of velocities v, m/s: v·normal ≥ least. A normal may have any length. [[put]] sets them.
  *
  * [[nearest]] and [[leastBroken]] are linear programmes, in two and in three dimensions. They take
  * [[Rounds]] rounds: each adds the half plane that the present velocity violates most, and finds the best
  * velocity on its edge, as incremental programming does (de Berg, Cheong, van Kreveld, Overmars:
  * ''Computational Geometry'', 3rd ed., 2008, chapter 4; van den Berg and others as in [[Avoidance]], section
  * 5). They need no more rounds than there are half planes, and hardly ever more than five.
  */
private[policy] final class HalfPlanes(val count: Int):
  private val normalNorth = new Array[Double](count)
  private val normalEast  = new Array[Double](count)
  private val least       = new Array[Double](count)

  def put(number: Int, normalNorth: Double, normalEast: Double, least: Double): Unit =
    this.normalNorth(number) = normalNorth
    this.normalEast(number) = normalEast
    this.least(number) = least

  /** The amount by which a velocity violates a half plane, times the length of its normal. */
  def broken(number: Int, of: Velocity): Double =
    least(number) - (normalNorth(number) * of.north + normalEast(number) * of.east)

  /** The velocity nearest to the wanted one within all half planes and the speed limit. */
  def nearest(wanted: Velocity, mostMps: Double): Nearest =
    val taken   = HalfPlanes(count.min(Rounds))
    var found   = wanted.limited(mostMps)
    var missing = 0.0
    for round <- 0 until taken.count do
      if takeMostBroken(found, taken, round) > Slack then
        val next = taken.onEdge(round, wanted, mostMps)
        found = next.velocity
        missing = missing.max(next.missing)
    if count > Rounds then missing = missing.max(takeMostBroken(found, taken, 0) - Slack)
    Nearest(found, missing)

  /** The velocity with the smallest worst violation, and of about equal ones the nearest to the wanted one:
    * it minimises the worst violation + |v − wanted|² / (2 [[Weight]]). Normals must have length 1 or 0.
    */
  def leastBroken(wanted: Velocity, mostMps: Double): Velocity =
    val taken = HalfPlanes(count.min(Rounds))
    var found = wanted
    var worst = Double.NegativeInfinity
    for round <- 0 until taken.count do
      if takeMostBroken(found, taken, round) > worst + Slack then
        // In the minimum with this half plane, it is the worst one.
        found = taken.whereWorst(round).inTurn(
          Velocity(
            wanted.north + Weight * taken.normalNorth(round),
            wanted.east + Weight * taken.normalEast(round)
          ),
          mostMps
        )
        worst = taken.broken(round, found)
    found

  /** Adds the half plane that a velocity violates most to those considered.
    *
    * @return the amount of its violation
    */
  private def takeMostBroken(of: Velocity, taken: HalfPlanes, at: Int): Double =
    var most      = broken(0, of)
    var north     = normalNorth(0)
    var east      = normalEast(0)
    var mostLeast = least(0)
    for k <- 1 until count do
      val its = broken(k, of)
      if its > most then
        most = its
        north = normalNorth(k)
        east = normalEast(k)
        mostLeast = least(k)
    taken.put(at, north, east, mostLeast)
    most

  /** The nearest velocity within the considered half planes, added one by one. */
  private def inTurn(wanted: Velocity, mostMps: Double): Velocity =
    var found = wanted.limited(mostMps)
    for i <- 0 until count do if broken(i, found) > 0 then found = onEdge(i, wanted, mostMps).velocity
    found

  /** The velocity on the edge of one half plane that is nearest to the wanted one within all earlier half
    * planes.
    */
  private def onEdge(number: Int, wanted: Velocity, mostMps: Double): Nearest =
    // The edge: foot + t (−east, north), for low ≤ t ≤ high.
    val north     = normalNorth(number)
    val east      = normalEast(number)
    val square    = north * north + east * east
    val footNorth = north * (least(number) / square)
    val footEast  = east * (least(number) / square)
    val inside    = mostMps * mostMps * square - least(number) * least(number)
    val half      = math.sqrt(inside.max(0)) / square
    var low       = -half
    var high      = half
    for k <- 0 until number do
      val rise  = normalEast(k) * north - normalNorth(k) * east
      val lacks = least(k) - (normalNorth(k) * footNorth + normalEast(k) * footEast)
      // Along a parallel edge, the other half plane holds everywhere or nowhere.
      val from = lacks / (rise + Tiny)
      if rise >= 0 then low = low.max(from) else high = high.min(from)
    val along = ((wanted.east - footEast) * north - (wanted.north - footNorth) * east) / square
    val at    = along.max(low).min(high)
    Nearest(Velocity(footNorth - at * east, footEast + at * north), (low - high).max(-inside))

  /** The half planes of velocities that violate no earlier half plane more than this one. */
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

  /** The nearest permitted velocity.
    *
    * @param missing 0 if it lies within all half planes; above 0 if no velocity does
    */
  final case class Nearest(velocity: Velocity, missing: Double)

  /** Maximum number of rounds. Only few of a vehicle's neighbours bound its velocity. */
  val Rounds = 8

  /** Largest violation of a half plane that counts as none, m/s: far above rounding of floats, and far below
    * a vehicle's accuracy.
    */
  private val Slack = 1e-4

  /** Bound for a half plane with a normal of 0, which then permits every velocity. */
  val Always: Double = -1e6

  /** Weight of a violation relative to the distance from the wanted velocity, m/s. It is so large that only
    * edges within 10⁻³ rad of one another count as parallel.
    */
  private val Weight = 1e4

  /** So small that adding it changes no number except 0. */
  private val Tiny = 1e-30

/** A horizontal velocity, m/s, in the world frame: north and east. */
private[policy] final case class Velocity(north: Double, east: Double):
  def +(other: Velocity): Velocity       = Velocity(north + other.north, east + other.east)
  def -(other: Velocity): Velocity       = Velocity(north - other.north, east - other.east)
  def *(factor: Double): Velocity        = Velocity(north * factor, east * factor)
  infix def dot(other: Velocity): Double = north * other.north + east * other.east

  /** The velocity, scaled down to the speed limit if it exceeds it. */
  def limited(mostMps: Double): Velocity =
    val speed = math.sqrt(this dot this)
    if speed > mostMps then this * (mostMps / speed) else this
