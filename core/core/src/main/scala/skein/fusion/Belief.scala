package skein.fusion

import skein.units.*

/** The estimate of a vehicle at a moment: position and velocity in NED, jointly normal. A Kalman filter's
  * state for constant velocity with white noise as acceleration.
  *
  * @param at on the clock of the measurements
  * @param positionNed mean, m
  * @param velocityNed mean, m/s
  * @param position covariance of the position, m²
  * @param cross of position (rows) and velocity, m²/s
  * @param velocity of the velocity, m²/s²
  */
final case class Belief(
    at: Instant,
    positionNed: Vector3,
    velocityNed: Vector3,
    position: Matrix3,
    cross: Matrix3,
    velocity: Matrix3
):

  /** The estimate predicted for a later moment.
    *
    * @param acceleration spectral density of the unknown acceleration along each axis, m²/s³. The noise it
    *   adds over Δt is Δt³/3, Δt²/2 and Δt times it: Bar-Shalom, Li and Kirubarajan, Estimation with
    *   Applications to Tracking and Navigation (2001), 6.2.2
    */
  def carriedTo(later: Instant, acceleration: Double): Belief =
    carriedBy(later.since(at).toSeconds, acceleration).copy(at = later)

  /** Predicts over a time step; the estimate's own instant stays unchanged. */
  private[fusion] def carriedBy(dtS: Double, acceleration: Double): Belief =
    def noise(variance: Double) = Matrix3.diagonal(acceleration * variance)
    Belief(
      at,
      positionNed + velocityNed * dtS,
      velocityNed,
      position + (cross + cross.transposed) * dtS + velocity * (dtS * dtS) + noise(dtS * dtS * dtS / 3),
      cross + velocity * dtS + noise(dtS * dtS / 2),
      velocity + noise(dtS)
    )

  /** The estimate updated by a measurement of its own moment. */
  def joined(measured: Measurement): Belief =
    val placed = joinedPosition(measured.positionNed, measured.covariance)
    measured.velocity.fold(placed)(velocity => placed.joinedVelocity(velocity.ned, velocity.covariance))

  private[fusion] def joinedPosition(ned: Vector3, covariance: Matrix3): Belief =
    val surprise = (position + covariance).inverse
    val (p, v)   = (position * surprise, cross.transposed * surprise)
    val off      = ned - positionNed
    Belief(
      at,
      positionNed + p * off,
      velocityNed + v * off,
      (position - p * position).symmetric,
      cross - p * cross,
      (velocity - v * cross).symmetric
    )

  private def joinedVelocity(ned: Vector3, covariance: Matrix3): Belief =
    val surprise = (velocity + covariance).inverse
    val (p, v)   = (cross * surprise, velocity * surprise)
    val off      = ned - velocityNed
    Belief(
      at,
      positionNed + p * off,
      velocityNed + v * off,
      (position - p * cross.transposed).symmetric,
      cross - p * velocity,
      (velocity - v * velocity).symmetric
    )

object Belief:
  /** The estimate after the first measurement.
    *
    * @param speedMps standard deviation of the velocity along each axis
    */
  private[fusion] def first(
      at: Instant,
      positionNed: Vector3,
      covariance: Matrix3,
      speedMps: Double
  ): Belief =
    Belief(at, positionNed, Vector3.Zero, covariance, Matrix3.Zero, Matrix3.diagonal(speedMps * speedMps))
