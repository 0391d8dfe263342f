package skein.fusion

import skein.units.*

/** The estimate of a vehicle's position and velocity at a moment, in NED, jointly normal: the state of a
  * Kalman filter for constant velocity with white noise as acceleration.
  *
  * @param at the moment, on the clock of the measurements
  * @param positionNed mean, m
  * @param velocityNed mean, m/s
  * @param position covariance of the position, m²
  * @param cross covariance of position (rows) and velocity (columns), m²/s
  * @param velocity covariance of the velocity, m²/s²
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
    * @param acceleration spectral density of the unknown acceleration along each axis, m²/s³. Over a time Δt
    *   it adds Δt³/3, Δt²/2 and Δt times its value to the covariances: Bar-Shalom, Li and Kirubarajan,
    *   Estimation with Applications to Tracking and Navigation (2001), 6.2.2
    */
  def carriedTo(later: Instant, acceleration: Double): Belief =
    carriedBy(later.since(at).toSeconds, acceleration).copy(at = later)

  /** Predicts over a time step, without changing the estimate's own time. */
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

  /** The estimate updated with a measurement taken at the time of the estimate. */
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
    * @param speedMps standard deviation of the velocity along each axis, if it was not measured
    */
  private[fusion] def first(
      at: Instant,
      positionNed: Vector3,
      covariance: Matrix3,
      speedMps: Double
  ): Belief =
    Belief(at, positionNed, Vector3.Zero, covariance, Matrix3.Zero, Matrix3.diagonal(speedMps * speedMps))
