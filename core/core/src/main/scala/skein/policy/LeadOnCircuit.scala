package skein.policy

/** Leads round a circuit: flies towards the point a fixed length ahead of its own place on it (pure pursuit;
  * Coulter, ''Implementation of the Pure Pursuit Path Tracking Algorithm'', CMU-RI-TR-92-01).
  *
  * @param aheadM about as far as the vehicle flies before it follows a command
  */
final case class LeadOnCircuit(circuit: Racetrack, speedMps: Double, aheadM: Double) extends GoalPolicy:
  def mostMps: Double = speedMps

  def wanted(seen: TeamObservation, aheadS: Double): (Double, Double) =
    circuit.point(circuit.nearest(seen.northM(seen.self), seen.eastM(seen.self)) + speedMps * aheadS)

  def course(seen: TeamObservation): Course =
    val (north, east)     = (seen.northM(seen.self), seen.eastM(seen.self))
    val (toNorth, toEast) = circuit.point(circuit.nearest(north, east) + aheadM)
    val direction         = StrictMath.hypot(toNorth - north, toEast - east)
    if direction == 0 then Course(seen.headingRad, speedMps)
    else Course(StrictMath.atan2(toEast - east, toNorth - north), speedMps)
