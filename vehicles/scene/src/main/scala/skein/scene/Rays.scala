package skein.scene

import skein.units.Vector3

/** Casts rays from one point and returns the first item that each hits. Bodies are sorted into sectors around
  * the point, by a monotonic substitute for the azimuth that needs no arc tangent, and within each by their
  * minimum distance; so a ray tests few of them.
  */
final class Rays(moment: Moment, origin: Vector3, rangeM: Double, except: Int):
  import Rays.*

  private val bodies: Array[Solid] = moment.solids.iterator
    .filter(solid => solid.item != except && nearest(solid) <= rangeM)
    .toArray
    .sortBy(nearest)
  private val nearAt: Array[Double]      = bodies.map(nearest)
  private val sectors: Array[Array[Int]] =
    val lists = Array.fill(Sectors)(Array.newBuilder[Int])
    for index <- bodies.indices do sectorsOf(bodies(index)).foreach(lists(_) += index)
    lists.map(_.result())

  /** The item that the last ray has hit; `Item.Nothing` if none. */
  var item: Int = Item.Nothing

  /** Distance along a unit direction to the first hit, m; infinite if nothing is within range. */
  def cast(dx: Double, dy: Double, dz: Double): Double =
    item = Item.Nothing
    var least = Double.PositiveInfinity
    if dz > 0 && origin.z <= 0 then
      val ground = -origin.z / dz
      if ground <= rangeM then
        least = ground
        item = Item.Ground
    val sector = sectors(sectorOf(dx, dy))
    var i      = 0
    while i < sector.length do
      val index = sector(i)
      if nearAt(index) >= least then i = sector.length
      else
        val at = bodies(index).hit(origin.x, origin.y, origin.z, dx, dy, dz, math.min(least, rangeM))
        if at < least then
          least = at
          item = bodies(index).item
        i += 1
    least

  private def nearest(solid: Solid): Double = math.max(0, (solid.centre - origin).norm - solid.reachM)

  /** The sectors that the body extends into: all, if it may be above or below. */
  private def sectorsOf(solid: Solid): Seq[Int] =
    val (x, y) = (solid.centre.x - origin.x, solid.centre.y - origin.y)
    if math.sqrt(x * x + y * y) <= solid.reachM then 0 until Sectors
    else
      val middle = azimuth(x, y)
      var low    = 0.0
      var high   = 0.0
      for corner <- solid.corners.grouped(3) do
        val apart = azimuth(corner(0) - origin.x, corner(1) - origin.y) - middle
        val short = if apart > 2 then apart - 4 else if apart < -2 then apart + 4 else apart
        low = math.min(low, short)
        high = math.max(high, short)
      // One more on each side, because of rounding.
      val first = math.floor((middle + low) * PerUnit).toInt - 1
      val last  = math.floor((middle + high) * PerUnit).toInt + 1
      if last - first >= Sectors then 0 until Sectors else (first to last).map(Math.floorMod(_, Sectors))

object Rays:
  private val Sectors = 256
  private val PerUnit = Sectors / 4.0

  /** A monotonic function of the azimuth: 0 at north, growing by 1 a quarter turn to below 4. */
  private def azimuth(x: Double, y: Double): Double =
    val sum = math.abs(x) + math.abs(y)
    if sum == 0 then 0
    else if y >= 0 then if x >= 0 then y / sum else 1 - x / sum
    else if x < 0 then 2 - y / sum
    else 3 + x / sum

  private def sectorOf(x: Double, y: Double): Int = math.min(Sectors - 1, (azimuth(x, y) * PerUnit).toInt)
