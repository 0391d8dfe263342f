package skein.vehicle

import skein.units.{Span, Vector3}

/** AirSim's path following: 50 times per second it commands a velocity towards a point ahead on the path
  * (`MultirotorApiBase::moveOnPath`).
  */
object PathFollowing:

  val Period: Span = Span.ofMillis(20)

  /** Distance below which AirSim treats two positions as one, m. */
  val DistanceAccuracyM = 0.5

  /** Default look-ahead distance, m.
    *
    * @param isAdaptive whether it increases with the vehicle's distance from the path
    */
  def lookaheadM(speedMps: Double, isAdaptive: Boolean): Double =
    (speedMps * Period.toSeconds * (if isAdaptive then 30 else 40)).max(DistanceAccuracyM * 1.5)

  /** The velocity to command, NED, m/s.
    *
    * @param wayNed vector from the vehicle to the point ahead, m
    */
  def velocityNed(wayNed: Vector3, speedMps: Double): Vector3 =
    val distance = wayNed.norm
    val velocity =
      if distance < DistanceAccuracyM then Vector3.Zero
      else wayNed * (speedMps.min(distance / Period.toSeconds) / distance)
    if wayNed.z.abs <= DistanceAccuracyM then velocity.copy(z = 0) else velocity
