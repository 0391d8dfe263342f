package skein.scene

import skein.signal.{NormalQuantile, SplitMix64}
import skein.units.Vector3

/** A lidar that turns around its down axis. The defaults are AirSim's for multirotors.
  *
  * @param place placement on the vehicle
  * @param rangeM objects beyond it give no point
  * @param horizontalFovDeg first and last angle, clockwise from the front; other points are dropped, as in
  *   AirSim; none is dropped if both are equal
  * @param noiseM standard deviation of the range
  * @param fresh whether a scan is taken on request, of that instant, instead of once a turn
  */
final case class Lidar(
    channels: Int = 16,
    rangeM: Double = 100,
    pointsPerSecond: Int = 100_000,
    rotationsPerSecond: Int = 10,
    horizontalFovDeg: (Double, Double) = (0, 359),
    verticalFovDeg: (Double, Double) = (-45, -15),
    place: Placement = Placement(Vector3.Zero),
    sensorFrame: Boolean = false,
    noiseM: Double = 0,
    seed: Long = 0,
    fresh: Boolean = false
):
  /** Rays in one turn: at most 100,000, as in AirSim. */
  val rays: Int = math.min(Lidar.MostRays, math.round(pointsPerSecond.toDouble / rotationsPerSecond).toInt)

  /** Ray directions in the lidar's frame, three numbers each. Consecutive rays belong to consecutive
    * channels, from the uppermost down; a channel's angular step is a turn divided by its number of rays, as
    * in AirSim.
    */
  private lazy val directions: Array[Double] =
    val perChannel     = math.max(1, math.round(rays.toDouble / channels)).toDouble
    val (lower, upper) = verticalFovDeg
    val (start, end)   = (turn(horizontalFovDeg._1), turn(horizontalFovDeg._2))
    (0 until rays).iterator.flatMap: ray =>
      val azimuth = (360.0 / perChannel * ray) % 360
      val seen    =
        if start < end then azimuth >= start && azimuth <= end else azimuth >= start || azimuth <= end
      val elevation =
        if channels == 1 then upper else upper - (upper - lower) / (channels - 1) * (ray % channels)
      val (a, e) = (StrictMath.toRadians(azimuth), StrictMath.toRadians(elevation))
      if seen then
        Iterator(
          StrictMath.cos(e) * StrictMath.cos(a),
          StrictMath.cos(e) * StrictMath.sin(a),
          -StrictMath.sin(e)
        )
      else Iterator.empty
    .toArray

  private def turn(deg: Double): Double = ((deg % 360) + 360) % 360

  /** The points that a scan from a vehicle at this place in the world hits, with their items.
    *
    * @param except the item that the vehicle is
    * @param origin origin of the points' frame in the world; unused if points are in the sensor's own frame
    * @param noise number of the scan, which selects its noise
    */
  def scan(moment: Moment, vehicle: Placement, except: Int, origin: Vector3, noise: Long): Lidar.Points =
    val sensor = vehicle.outside(place)
    val rays   = Rays(moment, sensor.position, rangeM, except)
    val random = SplitMix64(SplitMix64.seedOf(seed, noise))
    val xyz    = new Array[Float](directions.length)
    val items  = new Array[Int](directions.length / 3)
    var found  = 0
    var i      = 0
    while i < directions.length do
      val (x, y, z)    = (directions(i), directions(i + 1), directions(i + 2))
      val (f, r, d, p) = (sensor.front, sensor.right, sensor.down, sensor.position)
      val dx           = f.x * x + r.x * y + d.x * z
      val dy           = f.y * x + r.y * y + d.y * z
      val dz           = f.z * x + r.z * y + d.z * z
      val exact        = rays.cast(dx, dy, dz)
      if exact <= rangeM then
        val range =
          if noiseM == 0 then exact
          else exact + noiseM * NormalQuantile(math.max(random.nextDouble(), 1e-12))
        if sensorFrame then
          xyz(3 * found) = (range * x).toFloat
          xyz(3 * found + 1) = (range * y).toFloat
          xyz(3 * found + 2) = (range * z).toFloat
        else
          xyz(3 * found) = (p.x + range * dx - origin.x).toFloat
          xyz(3 * found + 1) = (p.y + range * dy - origin.y).toFloat
          xyz(3 * found + 2) = (p.z + range * dz - origin.z).toFloat
        items(found) = rays.item
        found += 1
      i += 3
    Lidar.Points(java.util.Arrays.copyOf(xyz, 3 * found), java.util.Arrays.copyOf(items, found))

object Lidar:
  /** Maximum number of rays in one scan, as in AirSim. */
  val MostRays = 100_000

  /** @param xyz x, y and z of each point, m
    * @param items the item that each point is on
    */
  final case class Points(xyz: Array[Float], items: Array[Int])
