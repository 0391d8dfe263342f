package skein.policy

import skein.units.*
import skein.vehicle.FirstOrderLag

/** Flies along a lane and avoids everything that a lidar detects, by the dynamic window approach (Fox,
  * Burgard, Thrun: The Dynamic Window Approach to Collision Avoidance, IEEE Robotics & Automation Magazine 4
  * (1997), 23). Each candidate heading and speed is simulated past the points of the newest scan, by a model
  * whose velocity follows the command with a lag. The policy chooses the best candidate along the lane that
  * keeps clear. Points are assumed not to move, and earlier scans are ignored. Without a scan, or if it is
  * too old, the vehicle stands still.
  *
  * @param sensor name of the lidar; [[skein.scenario.Equipment.Lidar]] describes its columns
  * @param laneNorthM north coordinate of a point on the lane, m
  * @param keepM distance to keep from the vehicle's body, if there is room
  * @param bodyM distance from the vehicle's centre to its farthest corner
  * @param lagS time constant of the velocity
  */
final case class DynamicWindow(
    sensor: String,
    laneNorthM: Double,
    laneEastM: Double,
    laneHeading: Radians,
    cruiseMps: Double,
    keepM: Double = 1.2,
    bodyM: Double = 0.5,
    lagS: Double = 0.55,
    horizonS: Double = 3
) extends Policy.Memoryless:
  import DynamicWindow.*

  override def isPlanar: Boolean = true

  override def sensors: Set[String] = Set(sensor)

  def action(seen: Observation): Action =
    val (heading, speed) = seen.sensed.get(sensor).filter(_.age < TooOld) match
      case None       => (seen.headingRad, 0.0)
      case Some(scan) =>
        best(seen.own.kinematics.positionNed, seen.own.kinematics.velocityNed, seen.headingRad, scan)
    seen.along(heading, speed)

  // The instants to check, and the time for which the velocity has carried the vehicle until each.
  private val instants       = (1 to (horizonS / StepS).toInt).map(_ * StepS).toArray
  private val carries        = instants.map(FirstOrderLag(lagS).carriesS)
  private val (laneN, laneE) =
    (StrictMath.cos(laneHeading.value), StrictMath.sin(laneHeading.value))

  /** Heading, rad, and speed, m/s, of the best candidate. */
  private def best(position: Vector3, velocity: Vector3, lastRad: Double, scan: Sensed): (Double, Double) =
    val points = near(position, scan)
    // Back to the lane at an angle, not straight across.
    val aside        = -(position.x - laneNorthM) * laneE + (position.y - laneEastM) * laneN
    val aimRad       = laneHeading.value - StrictMath.atan2(aside, AheadM)
    val (aimN, aimE) = (StrictMath.cos(aimRad), StrictMath.sin(aimRad))
    var least        = Double.PositiveInfinity
    var chosen       = (aimRad, 0.0)
    for turn <- Turns; share <- Shares do
      val headingRad = aimRad + turn
      val speed      = cruiseMps * share
      val (n, e)     = (speed * StrictMath.cos(headingRad), speed * StrictMath.sin(headingRad))
      val (clear, free, north, east) = flown(points, position, velocity, n, e)
      val progress = ((north - position.x) * aimN + (east - position.y) * aimE) / (cruiseMps * horizonS)
      val near     = ((keepM - clear) / keepM).max(0)
      val cost     = Ahead * (1 - progress) + Clear * near * near +
        (if free < instants.length then Hit * (1 + 1 - free.toDouble / instants.length) else 0.0) +
        Steady * (1 - StrictMath.cos(headingRad - lastRad))
      if cost < least then
        least = cost
        chosen = (headingRad, speed)
    chosen

  /** Simulates a command. Returns the smallest distance from the body to a point, m; the number of steps
    * until it touches a point; and the final position.
    */
  private def flown(
      points: Array[Double],
      position: Vector3,
      velocity: Vector3,
      n: Double,
      e: Double
  ): (Double, Int, Double, Double) =
    var (north, east) = (position.x, position.y)
    var clear2        = Double.PositiveInfinity
    var at            = 0
    var free          = instants.length
    while at < instants.length do
      north = position.x + n * instants(at) + (velocity.x - n) * carries(at)
      east = position.y + e * instants(at) + (velocity.y - e) * carries(at)
      var point = 0
      while point < points.length do
        val (dn, de) = (points(point) - north, points(point + 1) - east)
        val apart2   = dn * dn + de * de
        if apart2 < clear2 then clear2 = apart2
        point += 2
      if free == instants.length && clear2 < bodyM * bodyM then free = at
      at += 1
    (math.sqrt(clear2) - bodyM, free, north, east)

  private def near(position: Vector3, scan: Sensed): Array[Double] =
    val reach  = cruiseMps * horizonS + keepM + bodyM
    val points = Array.newBuilder[Double]
    val count  = scan.values.size - FirstRange
    for sector <- 0 until count do
      val range      = scan.values(FirstRange + sector)
      val azimuthRad = 2 * math.Pi * (sector + 0.5) / count
      val north      = scan.values(0) + range * StrictMath.cos(azimuthRad)
      val east       = scan.values(1) + range * StrictMath.sin(azimuthRad)
      if StrictMath.hypot(north - position.x, east - position.y) < reach then
        points += north
        points += east
    points.result()

object DynamicWindow:
  private val FirstRange = 3

  private val StepS  = 0.15
  private val AheadM = 10.0
  private val TooOld = Span.ofSeconds(1)

  private val Turns  = (-24 to 24).sortBy(_.abs).map(turn => StrictMath.toRadians(5.0 * turn))
  private val Shares = Vector(1.0, 0.65, 0.3)

  // Weights of the terms.
  private val Ahead  = 1.0
  private val Clear  = 2.0
  private val Hit    = 5.0
  private val Steady = 0.15
