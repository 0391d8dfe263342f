package skein.vehicle

import skein.units.{Span, Vector3}

/** How AirSim flies along a path: 50 times a second it aims at a point ahead, with a velocity
  * (`MultirotorApiBase::moveOnPath`).
  */
object PathFollowing:

  /** Between two velocities. */
  val Period: Span = Span.ofMillis(20)

  /** Nearer than this, m, AirSim takes two places for one. */
  val DistanceAccuracyM = 0.5

  /** How far ahead it aims where nobody said how far, m.
    *
    * @param isAdaptive whether it aims further, the further the vehicle has strayed from the path
    */
  def lookaheadM(speedMps: Double, isAdaptive: Boolean): Double =
    (speedMps * Period.toSeconds * (if isAdaptive then 30 else 40)).max(DistanceAccuracyM * 1.5)

  /** The velocity to command, NED, m/s.
    *
    * @param wayNed from the vehicle to the point it aims at, m
    */
  def velocityNed(wayNed: Vector3, speedMps: Double): Vector3 =
    val distance = wayNed.norm
    val velocity =
      if distance < DistanceAccuracyM then Vector3.Zero
      else wayNed * (speedMps.min(distance / Period.toSeconds) / distance)
    if wayNed.z.abs <= DistanceAccuracyM then velocity.copy(z = 0) else velocity
