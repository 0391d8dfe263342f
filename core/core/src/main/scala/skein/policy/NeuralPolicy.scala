package skein.policy

/** A small network of neurons with tanh. Its inputs are the opponent's position over [[NeuralPolicy.LengthM]]
  * and relative velocity over [[NeuralPolicy.SpeedMps]], each ahead and to the right in the frame of this
  * vehicle's heading. Its one output, between −1 and 1, times the maximum turn rate is the turn rate.
  *
  * A decision allocates two arrays as wide as the widest layer; compiled to SIMD it allocates nothing.
  *
  * @param parameters weights and biases in the order of [[NeuralShape]]
  * @param turnRateRadPerS maximum turn rate
  */
final case class NeuralPolicy(shape: NeuralShape, parameters: Vector[Double], turnRateRadPerS: Double = 1.0)
    extends HeadingPolicy.Memoryless:
  private val network = DenseNetwork(shape, parameters)

  def heading(seen: PlanarObservation): Double =
    import seen.*
    ownHeadingRad + turnRate(dxM, dyM, dvxMps, dvyMps, ownHeadingRad) * elapsedS

  /** The turn rate for a relative position and velocity, rad/s, positive to the right. */
  def turnRate(dxM: Double, dyM: Double, dvxMps: Double, dvyMps: Double, ownHeadingRad: Double): Double =
    val cos   = StrictMath.cos(ownHeadingRad)
    val sin   = StrictMath.sin(ownHeadingRad)
    val input = network.scratch
    input(0) = (dxM * cos + dyM * sin) / NeuralPolicy.LengthM
    input(1) = (dyM * cos - dxM * sin) / NeuralPolicy.LengthM
    input(2) = (dvxMps * cos + dvyMps * sin) / NeuralPolicy.SpeedMps
    input(3) = (dvyMps * cos - dvxMps * sin) / NeuralPolicy.SpeedMps
    turnRateRadPerS * network.output(input)

object NeuralPolicy:
  /** Scale of distances, m. The network resolves distances of about this size best. */
  val LengthM = 20.0

  /** Scale of velocities, m/s; see [[LengthM]]. */
  val SpeedMps = 10.0
