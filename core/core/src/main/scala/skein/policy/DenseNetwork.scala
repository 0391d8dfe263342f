package skein.policy

/** A network, evaluated by an ordinary loop over arrays, which the SIMD compiler can trace.
  *
  * @param parameters weights and biases in the order of [[NeuralShape]]
  */
private[policy] final class DenseNetwork(shape: NeuralShape, parameters: Vector[Double]):
  require(
    parameters.size == shape.parameters,
    s"a network of $shape has ${shape.parameters} parameters, got ${parameters.size}"
  )

  private val weights = parameters.toArray
  private val widths  = shape.widths.toArray
  private val widest  = shape.widest
  private val squash  = shape.activations.map(_.ordinal).toArray

  /** A new array with room for the inputs, and for the outputs of each layer. */
  def scratch: Array[Double] = Array.ofDim[Double](widest)

  def output(inputs: Array[Double]): Double = outputs(inputs)(0)

  /** Evaluates the network.
    *
    * @param inputs the network's inputs, in [[scratch]], which is overwritten
    */
  def outputs(inputs: Array[Double]): Array[Double] =
    var input  = inputs
    var output = scratch
    var at     = 0
    var layer  = 1
    while layer < widths.length do
      val kind   = squash(layer - 1)
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
        output(neuron) =
          if kind == DenseNetwork.Relu then sum.max(0.0)
          else if kind == DenseNetwork.Tanh then StrictMath.tanh(sum)
          else if kind == DenseNetwork.Elu then sum.max(0.0) + (StrictMath.exp(sum.min(0.0)) - 1.0)
          else sum.max(-1.0).min(1.0)
        neuron += 1
      val spare = input
      input = output
      output = spare
      layer += 1
    java.util.Arrays.copyOf(input, widths.last)

private[policy] object DenseNetwork:
  private final val Relu = 0
  private final val Tanh = 1
  private final val Elu  = 3
