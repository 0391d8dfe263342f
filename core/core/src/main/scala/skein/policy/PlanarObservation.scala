package skein.policy

/** What a [[HeadingPolicy]] observes of its opponent.
  *
  * @param dxM opponent's position minus own, north, m
  * @param dyM opponent's position minus own, east, m
  * @param dvxMps opponent's velocity minus own, north, m/s
  * @param dvyMps opponent's velocity minus own, east, m/s
  * @param ownHeadingRad last commanded heading of the own vehicle
  * @param opponentHeadingRad last commanded heading of the opponent, as far as known to this controller
  * @param elapsedS time since the own previous decision; 0 at the first
  * @param ownAgeS age of the reading of the own vehicle, s
  * @param opponentAgeS age of the reading of the opponent, s
  */
final case class PlanarObservation(
    dxM: Double,
    dyM: Double,
    dvxMps: Double,
    dvyMps: Double,
    ownHeadingRad: Double,
    opponentHeadingRad: Double,
    elapsedS: Double,
    ownAgeS: Double,
    opponentAgeS: Double
):
  /** The inputs of learned policies, in a frame whose x-axis is the own last commanded heading: the
    * opponent's position ahead and to the right, m; its velocity relative to the own, m/s; cosine and sine of
    * its heading relative to the own; the time since the own previous decision, and the ages of the own and
    * of the opponent's reading, s.
    */
  def fromOwnHeading: Array[Double] =
    val cos     = StrictMath.cos(ownHeadingRad)
    val sin     = StrictMath.sin(ownHeadingRad)
    val bearing = opponentHeadingRad - ownHeadingRad
    val into    = Array.ofDim[Double](9)
    into(0) = dxM * cos + dyM * sin
    into(1) = dyM * cos - dxM * sin
    into(2) = dvxMps * cos + dvyMps * sin
    into(3) = dvyMps * cos - dvxMps * sin
    into(4) = StrictMath.cos(bearing)
    into(5) = StrictMath.sin(bearing)
    into(6) = elapsedS
    into(7) = ownAgeS
    into(8) = opponentAgeS
    into

object PlanarObservation:
  def of(seen: Observation): PlanarObservation =
    val (own, opponent) = (seen.own, seen.vehicles(seen.opponent))
    val toOpponent      = opponent.kinematics.positionNed - own.kinematics.positionNed
    val closing         = opponent.kinematics.velocityNed - own.kinematics.velocityNed
    PlanarObservation(
      toOpponent.x,
      toOpponent.y,
      closing.x,
      closing.y,
      seen.headings(seen.self).value,
      seen.headings(seen.opponent).value,
      seen.elapsed.toSeconds,
      own.age.toSeconds,
      opponent.age.toSeconds
    )
