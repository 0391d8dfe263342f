package skein.policy

import skein.policy.Avoidance.*

/** Flies to a goal and keeps clear of all others by optimal reciprocal collision avoidance, ORCA. Of the
  * velocities that keep every pair apart for a time if each of the two does its half, it chooses the one
  * nearest to the wanted velocity (van den Berg, Guy, Lin, Manocha: ''Reciprocal n-Body Collision
  * Avoidance'', Robotics Research, STAR 70, 2011). If there is none, it chooses the velocity whose worst
  * violation is smallest, as in that paper. Both are linear programmes of a fixed size ([[HalfPlanes]]), so
  * that the rule is a formula: they contain every other vehicle; a vehicle out of reach has a bound that
  * always holds.
  *
  * The rule treats vehicles as discs that reach a commanded velocity immediately. A multirotor lags behind
  * its command, so the discs are wider than the required separation.
  *
  * @param goalNorthM north coordinate of the goal, m; `goalEastM` likewise. Within `cruiseMps / arrivePerS`
  *   of it the vehicle slows down in proportion to the distance
  * @param minimumM smallest separation allowed, m
  * @param marginM added to the minimum; the sum is the sum of the two discs' radii
  * @param horizonS time within which no two vehicles may meet
  * @param mostMps maximum commanded speed
  */
final case class Avoidance(
    goalNorthM: Double,
    goalEastM: Double,
    cruiseMps: Double,
    mostMps: Double,
    override val minimumM: Double,
    marginM: Double,
    horizonS: Double,
    arrivePerS: Double = 0.4
) extends Policy.Memoryless, Goal:
  private val apartM = minimumM + marginM
  require(apartM > 0 && horizonS > 0, s"discs of $apartM m and a horizon of $horizonS s keep nobody apart")

  override def isPlanar: Boolean = true

  def action(seen: Observation): Action =
    val wanted = preferred(seen)
    val bounds = boundsOf(seen)
    val within = bounds.nearest(wanted, mostMps)
    val chosen = if within.missing > 0 then bounds.leastBroken(wanted, mostMps) else within.velocity
    seen.towards(chosen.north, chosen.east, mostMps)

  def wanted(seen: Observation, aheadS: Double): (Double, Double) =
    val (north, east) = (goalNorthM - seen.northM(seen.self), goalEastM - seen.eastM(seen.self))
    val distance      = StrictMath.hypot(north, east)
    val share         = if distance == 0 then 1.0 else (cruiseMps * aheadS / distance).min(1)
    (seen.northM(seen.self) + share * north, seen.eastM(seen.self) + share * east)

  private def preferred(seen: Observation): Velocity =
    val (north, east) = (goalNorthM - seen.northM(seen.self), goalEastM - seen.eastM(seen.self))
    val distance      = StrictMath.hypot(north, east)
    if distance == 0 then Velocity(0, 0)
    else Velocity(north, east) * (cruiseMps.min(arrivePerS * distance) / distance)

  private def boundsOf(seen: Observation): HalfPlanes =
    val self   = seen.self
    val own    = Velocity(seen.northMps(self), seen.eastMps(self))
    val reach  = apartM + 2 * mostMps * horizonS
    val bounds = HalfPlanes(seen.count - 1)
    for i <- 0 until bounds.count do
      val other = if i < self then i else i + 1
      val north = seen.northM(other) - seen.northM(self)
      val east  = seen.eastM(other) - seen.eastM(self)
      if StrictMath.hypot(north, east) < reach then
        val its = bound(north, east, own, Velocity(seen.northMps(other), seen.eastMps(other)))
        bounds.put(i, its.normal.north, its.normal.east, its.at dot its.normal)
      else bounds.put(i, 0, 0, HalfPlanes.Always)
    bounds

  /** The half plane of velocities with which this vehicle does its half of avoiding another vehicle. The
    * other half is left to that vehicle: the plane contains half of the smallest change of the relative
    * velocity that avoids a conflict within the horizon.
    */
  private def bound(northM: Double, eastM: Double, own: Velocity, its: Velocity): Bound =
    val relative = own - its
    val square   = northM * northM + eastM * eastM
    if square <= apartM * apartM then
      // Already too near: must be apart again after a short time, not after the horizon.
      fromDisc(own, relative, Velocity(northM, eastM) * (1 / PartingS), apartM / PartingS)
    else
      val centre  = Velocity(northM, eastM) * (1 / horizonS)
      val off     = relative - centre
      val towards = off.north * northM + off.east * eastM
      if towards < 0 && towards * towards > apartM * apartM * (off dot off) then
        fromDisc(own, relative, centre, apartM / horizonS)
      else
        val leg   = math.sqrt(square - apartM * apartM)
        val left  = northM * off.east - eastM * off.north > 0
        val along =
          if left then Velocity(northM * leg - eastM * apartM, northM * apartM + eastM * leg) * (1 / square)
          else Velocity(northM * leg + eastM * apartM, -northM * apartM + eastM * leg) * (1 / square)
        val change = along * (relative dot along) - relative
        val normal = if left then Velocity(-along.east, along.north) else Velocity(along.east, -along.north)
        Bound(own + change * 0.5, normal)

  /** The bound that follows from the shortest way out of a disc of relative velocities. */
  private def fromDisc(own: Velocity, relative: Velocity, centre: Velocity, radius: Double): Bound =
    val off    = relative - centre
    val length = math.sqrt(off dot off)
    val back   = math.sqrt(centre dot centre)
    // At the centre all ways out are equally long; the one away from the other vehicle is taken.
    val normal =
      if length > 0 then off * (1 / length)
      else if back > 0 then centre * (-1 / back)
      else Velocity(1, 0)
    Bound(own + normal * (0.5 * (radius - length)), normal)

object Avoidance:

  /** Time within which two vehicles that are too close must be apart again, s. */
  private[policy] val PartingS = 0.5

  /** A half plane of velocities v, m/s: (v − at)·normal ≥ 0. */
  private[policy] final case class Bound(at: Velocity, normal: Velocity)
