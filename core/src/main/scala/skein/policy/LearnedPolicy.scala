package skein.policy

/** What a learner learned: a network of rectifiers of all that it sees ([[PlanarObservation.fromOwnHeading]] over
  * [[LearnedPolicy.scales]]), whose one output, squashed by tanh, says how to turn.
  *
  * Allocates two arrays as wide as its widest layer at a decision, and one of what it sees.
  *
  * @param parameters
  *   as [[NeuralShape]] lays them out
  * @param turnRateRadPerS
  *   the most that it turns until the next decision
  * @param turnRad
  *   the most that it turns at once
  */
final case class LearnedPolicy(
    shape: NeuralShape,
    parameters: Vector[Double],
    turnRateRadPerS: Double,
    turnRad: Double
) extends ObservingPolicy[Double]:
  require(
    shape.inputs == LearnedPolicy.Inputs,
    s"a learned policy has ${LearnedPolicy.Inputs} inputs, got ${shape.inputs}"
  )
  require(
    parameters.size == shape.parameters,
    s"a network of $shape has ${shape.parameters} parameters, got ${parameters.size}"
  )

  private val weights = parameters.toArray
  private val widths  = shape.widths.toArray
  private val widest  = shape.widest
  private val scales  = LearnedPolicy.scales.toArray

  /** Nothing is remembered; a number flies by lanes. */
  def initial: Double = 0

  def decide(seen: PlanarObservation, memory: Double): Decided[Double] =
    Decided(seen.ownHeadingRad + share(seen) * (turnRateRadPerS * seen.elapsedS + turnRad), memory)

  /** Of the most that it turns: −1 to 1, to the right. */
  def share(seen: PlanarObservation): Double =
    val what   = seen.fromOwnHeading
    var input  = Array.ofDim[Double](widest)
    var output = Array.ofDim[Double](widest)
    var i      = 0
    while i < LearnedPolicy.Inputs do
      input(i) = what(i) / scales(i)
      i += 1
    var at    = 0
    var layer = 1
    while layer < widths.length do
      val isLast = layer == widths.length - 1
      var neuron = 0
      while neuron < widths(layer) do
        var sum = 0.0
        var i   = 0
        while i < widths(layer - 1) do
          sum += weights(at) * input(i)
          at += 1
          i += 1
        sum += weights(at)
        at += 1
        output(neuron) = if isLast then StrictMath.tanh(sum) else sum.max(0.0)
        neuron += 1
      val spare = input
      input = output
      output = spare
      layer += 1
    input(0)

object LearnedPolicy:
  /** Numbers that it sees. */
  val Inputs = 9

  /** What a learner's numbers are divided by, so that all are of about −1 to 1. */
  val scales: Vector[Double] = Vector(20, 20, 10, 10, 1, 1, 0.2, 0.2, 0.2)
