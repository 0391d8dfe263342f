package skein.policy

/** A small network of neurons with tanh. It sees the opponent in the own frame (the own heading is ahead):
  * position over [[NeuralPolicy.LengthM]] and relative velocity over [[NeuralPolicy.SpeedMps]], each ahead
  * and to the right; its one output, in −1 to 1, times the turn rate is how fast it turns.
  *
  * Allocates two arrays as wide as its widest layer at a decision; compiled to SIMD it allocates none.
  *
  * @param parameters as [[NeuralShape]] lays them out
  * @param turnRateRadPerS the most that it turns
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
  /** Scale of distances, m: the network distinguishes those of about this size best. */
  val LengthM = 20.0

  /** Scale of velocities, m/s, as [[LengthM]] for distances. */
  val SpeedMps = 10.0
