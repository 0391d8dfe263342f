package skein.policy

/** The observation of a [[HeadingPolicy]].
  *
  * @param dxM the opponent's position minus this vehicle's, north, m
  * @param dyM the opponent's position minus this vehicle's, east, m
  * @param dvxMps the opponent's velocity minus this vehicle's, north, m/s
  * @param dvyMps the opponent's velocity minus this vehicle's, east, m/s
  * @param ownHeadingRad last commanded heading of this vehicle
  * @param opponentHeadingRad last commanded heading of the opponent, as far as known to this controller
  * @param elapsedS time since this vehicle's previous decision; 0 at the first
  * @param ownAgeS age of the reading of this vehicle, s
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
  /** The inputs of learned policies, in a frame whose x-axis is this vehicle's last commanded heading: the
    * opponent's position ahead and to the right, m; its velocity relative to this vehicle's, m/s; cosine and
    * sine of its heading relative to this vehicle's; the time since this vehicle's previous decision, and the
    * ages of this vehicle's and of the opponent's reading, s.
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
