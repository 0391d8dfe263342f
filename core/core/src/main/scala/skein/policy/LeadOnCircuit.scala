package skein.policy

/** Leads a group round a circuit: flies towards the point a fixed length ahead of its own place on the
  * circuit (pure pursuit; Coulter, ''Implementation of the Pure Pursuit Path Tracking Algorithm'',
  * CMU-RI-TR-92-01).
  *
  * @param aheadM about the distance that the vehicle flies before it follows a command
  */
final case class LeadOnCircuit(circuit: Racetrack, speedMps: Double, aheadM: Double)
    extends Policy.Memoryless, Goal:
  def mostMps: Double = speedMps

  def wanted(seen: Observation, aheadS: Double): (Double, Double) =
    circuit.point(circuit.nearest(seen.northM(seen.self), seen.eastM(seen.self)) + speedMps * aheadS)

  override def isPlanar: Boolean = true

  def action(seen: Observation): Action =
    val (north, east)     = (seen.northM(seen.self), seen.eastM(seen.self))
    val (toNorth, toEast) = circuit.point(circuit.nearest(north, east) + aheadM)
    val distance          = StrictMath.hypot(toNorth - north, toEast - east)
    val heading = if distance == 0 then seen.headingRad else StrictMath.atan2(toEast - east, toNorth - north)
    seen.along(heading, speedMps)
