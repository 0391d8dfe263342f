package skein.vehicle

import skein.signal.Kinematics

/** An estimate of a few parameters: their mean and covariance, as in a Kalman filter. Immutable.
  *
  * Source of the update: Gelb (ed.), "Applied Optimal Estimation", 1974, section 4.2, for one measurement at
  * a time.
  */
final case class ParameterBelief private[vehicle] (mean: Vector[Double], covariance: Vector[Vector[Double]]):

  /** Adds a measurement.
    *
    * @param effects the measurement's derivative by each parameter
    * @param error measured minus predicted by the mean
    * @param noise the measurement's standard deviation
    */
  def updated(effects: Vector[Double], error: Double, noise: Double): ParameterBelief =
    val spread = covariance.map(row => row.lazyZip(effects).map(_ * _).sum)
    val gain   = spread.map(_ / (noise * noise + spread.lazyZip(effects).map(_ * _).sum))
    ParameterBelief(
      mean.lazyZip(gain).map(_ + _ * error),
      Vector.tabulate(mean.size, mean.size)((i, j) => covariance(i)(j) - gain(i) * spread(j))
    )

  /** Adds a reading's outputs, one after the other.
    *
    * @param predicted the outputs by the mean
    * @param noises the outputs' standard deviations
    * @param effects an output's derivative by each parameter, by the output's index
    */
  private[vehicle] def updatedAll(
      measured: Vector[Double],
      predicted: Vector[Double],
      noises: Vector[Double]
  )(
      effects: Int => Vector[Double]
  ): ParameterBelief = measured.indices.foldLeft(this): (belief, i) =>
    val by = effects(i)
    // The update by an earlier output of this reading already changes the prediction of this output.
    val explained = belief.mean.lazyZip(mean).map(_ - _).lazyZip(by).map(_ * _).sum
    belief.updated(by, measured(i) - predicted(i) - explained, noises(i))

  /** The estimate after `s` seconds in which each parameter changes by a random walk.
    *
    * @param drifts standard deviations of the changes within a second
    * @param most maximum standard deviations
    */
  def drifted(drifts: Vector[Double], s: Double, most: Vector[Double]): ParameterBelief =
    val added = Vector.tabulate(mean.size): i =>
      (drifts(i) * drifts(i) * s).min((most(i) * most(i) - covariance(i)(i)).max(0))
    copy(covariance =
      Vector.tabulate(mean.size, mean.size)((i, j) => covariance(i)(j) + (if i == j then added(i) else 0))
    )

  /** Limits each mean to a maximum magnitude; the covariance is unchanged. */
  def within(most: Vector[Double]): ParameterBelief =
    copy(mean = mean.lazyZip(most).map((x, limit) => x.max(-limit).min(limit)))

object ParameterBelief:
  /** What beliefs about a quadrotor are compared with: its velocity NED, m/s, and the horizontal components
    * of the direction opposite to its thrust.
    */
  private[vehicle] def outputs(of: Kinematics): Vector[Double] =
    import of.orientation.{w, x, y, z}
    import of.velocityNed
    Vector(velocityNed.x, velocityNed.y, velocityNed.z, 2 * (x * z + w * y), 2 * (y * z - w * x))

  /** Means of 0, and independent parameters with these standard deviations. */
  def apply(deviations: Vector[Double]): ParameterBelief = new ParameterBelief(
    deviations.map(_ => 0.0),
    Vector.tabulate(deviations.size, deviations.size): (i, j) =>
      if i == j then deviations(i) * deviations(i) else 0.0
  )
