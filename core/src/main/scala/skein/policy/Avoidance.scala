package skein.policy

import skein.policy.Avoidance.*

/** Flies to a goal and keeps clear of all others by optimal reciprocal collision avoidance, ORCA: of the velocities that
  * keep every pair apart for a time if each of the two does its half, the one nearest to that wanted (van den Berg, Guy,
  * Lin, Manocha: ''Reciprocal n-Body Collision Avoidance'', Robotics Research, STAR 70, 2011). Where there is none, the
  * one that violates the worst of the bounds least, as there.
  *
  * The rule takes vehicles for discs that have the commanded velocity at once; a multirotor lags behind, so the discs
  * are wider than the separation to be kept.
  *
  * @param goalNorthM
  *   where it wants to be; nearer than `cruiseMps / arrivePerS` it slows down in proportion
  * @param minimumM
  *   the separation that is set
  * @param marginM
  *   on top of it: the two discs' radii together are the sum
  * @param horizonS
  *   for how long no two shall meet
  * @param mostMps
  *   the fastest that is commanded
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
) extends GoalPolicy:
  private val apartM = minimumM + marginM
  require(apartM > 0 && horizonS > 0, s"discs of $apartM m and a horizon of $horizonS s keep nobody apart")

  def course(seen: TeamObservation): Course =
    val wanted = preferred(seen)
    val bounds = boundsOf(seen)
    val chosen = nearestAllowed(wanted, bounds, mostMps, relaxedMps = 0)
      .getOrElse(leastViolation(wanted, bounds, mostMps))
    Course.of(chosen.north, chosen.east, mostMps, seen.headingRad)

  def wanted(seen: TeamObservation, aheadS: Double): (Double, Double) =
    val (north, east) = (goalNorthM - seen.northM(seen.self), goalEastM - seen.eastM(seen.self))
    val distance      = StrictMath.hypot(north, east)
    val share         = if distance == 0 then 1.0 else (cruiseMps * aheadS / distance).min(1)
    (seen.northM(seen.self) + share * north, seen.eastM(seen.self) + share * east)

  private def preferred(seen: TeamObservation): Velocity =
    val (north, east) = (goalNorthM - seen.northM(seen.self), goalEastM - seen.eastM(seen.self))
    val distance      = StrictMath.hypot(north, east)
    if distance == 0 then Velocity(0, 0)
    else Velocity(north, east) * (cruiseMps.min(arrivePerS * distance) / distance)

  private def boundsOf(seen: TeamObservation): Array[Bound] =
    val self  = seen.self
    val own   = Velocity(seen.northMps(self), seen.eastMps(self))
    val reach = apartM + 2 * mostMps * horizonS
    (for
      other <- Array.range(0, seen.count) if other != self
      north = seen.northM(other) - seen.northM(self)
      east  = seen.eastM(other) - seen.eastM(self)
      if StrictMath.hypot(north, east) < reach
    yield bound(north, east, own, Velocity(seen.northMps(other), seen.eastMps(other))))

  /** The half plane of velocities that is this vehicle's half of keeping clear of another one: the smallest change u of
    * the relative velocity that leaves the cone of those which lead to a meeting within the horizon, half of it taken on.
    */
  private def bound(northM: Double, eastM: Double, own: Velocity, its: Velocity): Bound =
    val relative = own - its
    val square   = northM * northM + eastM * eastM
    if square <= apartM * apartM then
      // Too near already: apart again after a short while, not after the horizon.
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

  /** Out of a disc of relative velocities, by the shortest way. */
  private def fromDisc(own: Velocity, relative: Velocity, centre: Velocity, radius: Double): Bound =
    val off    = relative - centre
    val length = math.sqrt(off dot off)
    val back   = math.sqrt(centre dot centre)
    // In its very middle every way out is as short: then back, away from the other one.
    val normal =
      if length > 0 then off * (1 / length)
      else if back > 0 then centre * (-1 / back)
      else Velocity(1, 0)
    Bound(own + normal * (0.5 * (radius - length)), normal)

object Avoidance:

  /** Within which two vehicles that are too near to one another are to be apart again. */
  private[policy] val PartingS = 0.5

  /** Bisections of how far bounds must give way: to a 10⁻⁶ of the largest violation. */
  private val Halvings = 20

  /** A horizontal velocity, m/s. */
  private[policy] final case class Velocity(north: Double, east: Double):
    def +(other: Velocity): Velocity       = Velocity(north + other.north, east + other.east)
    def -(other: Velocity): Velocity       = Velocity(north - other.north, east - other.east)
    def *(factor: Double): Velocity        = Velocity(north * factor, east * factor)
    infix def dot(other: Velocity): Double = north * other.north + east * other.east

  /** Velocities v with (v − at)·normal ≥ 0. */
  private[policy] final case class Bound(at: Velocity, normal: Velocity):
    def direction: Velocity             = Velocity(normal.east, -normal.north)
    def violation(of: Velocity): Double = (at - of) dot normal
    def relaxed(byMps: Double): Bound   = Bound(at - normal * byMps, normal)

  /** The allowed velocity nearest to that wanted. It is the wanted one itself, or its foot on one bound or on the limit
    * of speed, or a corner where two of them meet: all of these are tried.
    *
    * @param relaxedMps
    *   how far each bound gives way
    */
  private[policy] def nearestAllowed(
      wanted: Velocity,
      bounds: Array[Bound],
      mostMps: Double,
      relaxedMps: Double
  ): Option[Velocity] =
    val held                               = bounds.map(_.relaxed(relaxedMps))
    var best: Option[Velocity]             = None
    var bestSquare                         = Double.PositiveInfinity
    def attempt(candidate: Velocity): Unit =
      val away   = candidate - wanted
      val square = away dot away
      if square < bestSquare && (candidate dot candidate) <= mostMps * mostMps * (1 + Slack) &&
        held.forall(_.violation(candidate) <= Slack)
      then
        best = Some(candidate)
        bestSquare = square

    attempt(wanted)
    val speed = math.sqrt(wanted dot wanted)
    if speed > mostMps then attempt(wanted * (mostMps / speed))
    if best.isEmpty then
      for i <- held.indices do
        val one = held(i)
        attempt(one.at + one.direction * ((wanted - one.at) dot one.direction))
        atLimit(one, mostMps).foreach(attempt)
        for j <- 0 until i do corner(one, held(j)).foreach(attempt)
    best

  /** The velocity for which the worst violation is least. */
  private[policy] def leastViolation(wanted: Velocity, bounds: Array[Bound], mostMps: Double): Velocity =
    // Standing still is within the limit of speed: relaxed so far, at least it is allowed.
    var enough = bounds.map(_.violation(Velocity(0, 0))).max.max(0)
    var least  = 0.0
    for _ <- 1 to Halvings do
      val middle = (least + enough) / 2
      if nearestAllowed(wanted, bounds, mostMps, middle).isDefined then enough = middle else least = middle
    nearestAllowed(wanted, bounds, mostMps, enough).getOrElse(Velocity(0, 0))

  private val Slack = 1e-9

  /** Where a bound's edge meets the limit of speed. */
  private def atLimit(bound: Bound, mostMps: Double): Seq[Velocity] =
    val along  = bound.direction
    val middle = bound.at - along * (bound.at dot along)
    val square = mostMps * mostMps - (middle dot middle)
    if square < 0 then Nil
    else
      val half = math.sqrt(square)
      Seq(middle + along * half, middle - along * half)

  private def corner(one: Bound, other: Bound): Option[Velocity] =
    val along = one.direction
    val rise  = along dot other.normal
    Option.when(math.abs(rise) > 1e-12)(one.at + along * (other.violation(one.at) / rise))
