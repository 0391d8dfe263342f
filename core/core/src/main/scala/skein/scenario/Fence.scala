package skein.scenario

/** The area that vehicles must not leave, seen from above; coordinates are north and east, m. */
enum Fence:
  case Circle(northM: Double, eastM: Double, radiusM: Double)

  /** A polygon that vehicles must stay in.
    *
    * @param corners north and east of each corner, in order around the polygon; at least three
    */
  case Polygon(corners: Vector[(Double, Double)])

  /** Distance of a position from the fence, m; negative inside. */
  def beyondM(north: Double, east: Double): Double = this match
    case Circle(middleN, middleE, radius) => StrictMath.hypot(north - middleN, east - middleE) - radius
    case Polygon(corners)                 =>
      var nearest  = Double.PositiveInfinity
      var isInside = false
      var at       = 0
      while at < corners.size do
        val (n1, e1)         = corners(at)
        val (n2, e2)         = corners((at + 1) % corners.size)
        val (alongN, alongE) = (n2 - n1, e2 - e1)
        val length           = alongN * alongN + alongE * alongE
        val share            =
          if length == 0 then 0.0
          else ((north - n1) * (alongN / length) + (east - e1) * (alongE / length)).max(0).min(1)
        nearest =
          nearest.min(StrictMath.hypot(north - n1 - share * alongN, east - e1 - share * alongE))
        if (e1 > east) != (e2 > east) && north < (east - e1) * (alongN / alongE) + n1 then
          isInside = !isInside
        at += 1
      if isInside then -nearest else nearest

  /** The fence in coordinates with another origin, limited to 1,000 km so that floats can represent their
    * squares.
    */
  def from(northM: Double, eastM: Double): Fence =
    def within(value: Double) = value.max(-1e6).min(1e6)
    this match
      case Circle(north, east, radius) => Circle(within(north - northM), within(east - eastM), radius)
      case Polygon(corners)            =>
        Polygon(corners.map((north, east) => (within(north - northM), within(east - eastM))))

object Fence:
  def rectangle(minNorthM: Double, maxNorthM: Double, minEastM: Double, maxEastM: Double): Fence =
    require(minNorthM < maxNorthM && minEastM < maxEastM, "a rectangle must have an inside")
    Polygon(
      Vector((minNorthM, minEastM), (maxNorthM, minEastM), (maxNorthM, maxEastM), (minNorthM, maxEastM))
    )
