package skein.policy

/** Follows a vehicle round a circuit, at a distance along the circuit. Steers towards the point a fixed
  * length ahead of its own place on it ([[LeadOnCircuit]]). Its speed is that of the vehicle ahead, corrected
  * in proportion to the error of the gap. It never turns back, but waits. A policy for vehicles that cannot
  * turn on the spot.
  *
  * @param leader index of the vehicle ahead in the scenario
  * @param aheadM about the distance that the vehicle drives before it follows a command
  * @param perS speed per metre of excess gap
  */
final case class FollowOnCircuit(
    leader: Int,
    circuit: Racetrack,
    gapM: Double,
    mostMps: Double,
    aheadM: Double,
    perS: Double = 0.5
) extends Policy.Memoryless:

  override def isPlanar: Boolean = true

  def action(seen: Observation): Action =
    val (north, east)     = (seen.northM(seen.self), seen.eastM(seen.self))
    val place             = circuit.nearest(north, east)
    val round             = circuit.nearest(seen.northM(leader), seen.eastM(leader)) - place
    val gap               = round - circuit.lengthM * math.floor(round / circuit.lengthM)
    val leaderMps         = StrictMath.hypot(seen.northMps(leader), seen.eastMps(leader))
    val speed             = (leaderMps + perS * (gap - gapM)).max(0.0).min(mostMps)
    val (toNorth, toEast) = circuit.point(place + aheadM)
    seen.along(StrictMath.atan2(toEast - east, toNorth - north), speed)
