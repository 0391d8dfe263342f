package skein.vehicle

/** Drives a car by commanded velocities. It steers onto the arc that removes the heading error within a time,
  * and approaches the speed with a time constant, more slowly while it turns. At a commanded speed near zero
  * it brakes. It never drives backwards, but turns round instead.
  *
  * @param headingS time within which it corrects a heading error
  * @param speedS time constant of the speed
  * @param leastShare share of the commanded speed at large heading errors
  */
final case class CarDriver(headingS: Double = 0.8, speedS: Double = 0.5, leastShare: Double = 0.4):

  /** The driver's controls for a commanded velocity.
    *
    * @param northMps commanded velocity north; `eastMps` likewise
    */
  def controls(
      car: SingleTrack,
      headingRad: Double,
      speedMps: Double,
      northMps: Double,
      eastMps: Double
  ): CarControls =
    val commanded = StrictMath.hypot(northMps, eastMps)
    val off       = math.IEEEremainder(StrictMath.atan2(eastMps, northMps) - headingRad, 2 * math.Pi)
    val wanted    = commanded * StrictMath.cos(off).max(leastShare)
    val steered   = StrictMath.atan2(car.wheelbaseM * off / headingS, speedMps.max(1.0))
    val mps2      = (wanted - speedMps) / speedS + car.coastMps2(speedMps)
    val stands    = commanded < CarDriver.StandsMps
    CarControls(
      if stands then 0.0 else (mps2 / car.driveMps2(speedMps)).max(0.0).min(1.0),
      if stands then 0.0 else (steered / car.mostSteeredRad).max(-1.0).min(1.0),
      if stands then 1.0 else (-mps2 / car.brakeMps2).max(0.0).min(1.0)
    )

object CarDriver:
  /** Commanded speed below which a command means "stand still", m/s. */
  private val StandsMps = 1e-3
