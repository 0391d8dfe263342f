package skein.vehicle

import skein.units.{MetresPerSecond, Vector3}

/** Steers to a position by commanding velocities. A vehicle that follows them with a lag of 0.9 s, as
  * AirSim's does, does not overshoot: 1.5² ≈ 4 · 0.6 · 0.9.
  */
object GoTo:
  private val PerMetre = 0.6
  private val Damping  = 0.5

  /** The velocity to command, NED, m/s, in the frame of the positions.
    *
    * @param cruise maximum speed, m/s
    */
  def velocityNed(
      positionNed: Vector3,
      velocityNed: Vector3,
      goalNed: Vector3,
      cruise: MetresPerSecond
  ): Vector3 =
    val wanted = (goalNed - positionNed) * PerMetre
    val most   = cruise.value * (1 + Damping)
    val within = if wanted.norm > most then wanted * (most / wanted.norm) else wanted
    within - velocityNed * Damping
