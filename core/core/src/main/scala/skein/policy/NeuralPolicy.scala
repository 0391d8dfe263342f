package skein.policy

/** A small network of neurons with tanh. It sees the opponent in the own frame (the own heading is ahead):
  * position over [[NeuralPolicy.LengthM]] and relative velocity over [[NeuralPolicy.SpeedMps]], each ahead
  * and to the right; its one output, in −1 to 1, times the turn rate is how fast it turns.
  *
  * Allocates two arrays as wide as its widest layer at a decision; by lanes the network has no arrays.
  *
  * @param parameters as [[NeuralShape]] lays them out
  * @param turnRateRadPerS the most that it turns
  */
final case class NeuralPolicy(shape: NeuralShape, parameters: Vector[Double], turnRateRadPerS: Double = 1.0)
    extends HeadingPolicy:
  private val network = DenseNetwork(shape, parameters)

  def heading(
      dxM: Double,
      dyM: Double,
      dvxMps: Double,
      dvyMps: Double,
      ownHeadingRad: Double,
      opponentHeadingRad: Double,
      elapsedS: Double
  ): Double = ownHeadingRad + turnRate(dxM, dyM, dvxMps, dvyMps, ownHeadingRad) * elapsedS

  /** rad/s, to the right. */
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
  /** Distances of about this much are seen best, m. */
  val LengthM = 20.0

  /** The same for velocities, m/s. */
  val SpeedMps = 10.0
