package skein.learn

import java.io.{DataInput, DataOutput}
import skein.signal.SplitMix64
import skein.units.{eachBelow, eachFrom}

/** A dense network: hidden layers with rectifiers (negative values become 0), and linear outputs. Mutable.
  *
  * @param widths numbers of inputs, of neurons in each hidden layer, and of outputs
  */
final class Network(val widths: Vector[Int]) extends Saved:
  require(
    widths.sizeIs >= 2 && widths.forall(width => width >= 1 && width <= Network.MostWidth),
    s"expected inputs and outputs, each layer of 1 to ${Network.MostWidth}, got ${widths.mkString("x")}"
  )

  val inputs: Int  = widths.head
  val outputs: Int = widths.last
  val layers: Int  = widths.size - 1

  private val starts =
    Vector.tabulate(layers)(layer => (widths(layer) + 1) * widths(layer + 1)).scanLeft(0)(_ + _)

  /** Layer by layer: the weights, grouped by input, then the biases. Call [[changed]] after changing them. */
  val parameters: Array[Float] = Array.ofDim(starts.last)

  /** The weights of each layer after the first, grouped by output. */
  private val turned = Vector.tabulate(layers)(layer => Array.ofDim[Float](widths(layer) * widths(layer + 1)))

  /** Index of the weight of the first input to the first neuron of a layer. */
  def weightsAt(layer: Int): Int = starts(layer)

  def biasesAt(layer: Int): Int = starts(layer) + widths(layer) * widths(layer + 1)

  private[learn] def weightsByOutput(layer: Int): Array[Float] = turned(layer)

  /** Must be called after the parameters were changed. */
  def changed(): Unit =
    for layer <- 0 until layers do
      val (into, ins, outs) = (turned(layer), widths(layer), widths(layer + 1))
      eachBelow(ins): i =>
        val from = weightsAt(layer) + i * outs
        eachBelow(outs): j =>
          into(j * ins + i) = parameters(from + j)

  /** Draws all parameters of a layer uniformly from ± 1 / √inputs.
    *
    * @param lastScale additional factor for the last layer
    */
  def draw(random: SplitMix64, lastScale: Double = 1): Network =
    for layer <- 0 until layers do
      val bound = (if layer == layers - 1 then lastScale else 1) / math.sqrt(widths(layer))
      for at <- weightsAt(layer) until starts(layer + 1) do
        parameters(at) = ((2 * random.nextDouble() - 1) * bound).toFloat
    changed()
    this

  /** Sets an input's weights to zero, so that nothing depends on it yet. */
  def ignore(input: Int): Unit =
    java.util.Arrays.fill(parameters, input * widths(1), (input + 1) * widths(1), 0f)
    changed()

  def take(other: Network): Unit =
    System.arraycopy(other.parameters, 0, parameters, 0, parameters.length)
    changed()

  /** Moves the parameters towards another network's by the fraction `rate`. */
  def follow(other: Network, rate: Float): Unit =
    val (own, its) = (parameters, other.parameters)
    eachBelow(own.length): i =>
      own(i) = own(i) + rate * (its(i) - own(i))
    changed()

  def isFinite: Boolean = parameters.forall(_.isFinite)

  def save(out: DataOutput): Unit = Saved.write(out, parameters)

  def load(in: DataInput): Unit =
    Saved.read(in, parameters)
    changed()

object Network:
  val MostWidth = 1024

/** Forward and backward computation of a network for some rows of inputs. Different rows may be computed by
  * different threads.
  *
  * @param widths widths of the networks that use it
  */
final class Pass(widths: Vector[Int], val rows: Int):
  private val activations = widths.map(width => Array.ofDim[Float](rows * width)).toArray
  private val errors      = widths.map(width => Array.ofDim[Float](rows * width)).toArray
  private val layers      = widths.size - 1

  /** Inputs and outputs, row by row, to be set and read. */
  def input: Array[Float]  = activations(0)
  def output: Array[Float] = activations(layers)

  /** Derivatives of the loss with respect to the outputs; to be set before going backward. */
  def outputError: Array[Float] = errors(layers)

  /** Derivatives with respect to the inputs, after [[backwardToInput]]. */
  def inputError: Array[Float] = errors(0)

  /** Computes the outputs for rows of observations. */
  def forward(network: Network, seen: Array[Float], from: Int, until: Int): Unit =
    System.arraycopy(seen, from * widths(0), input, from * widths(0), (until - from) * widths(0))
    forward(network, from, until)

  /** @param until the row after the last */
  def forward(network: Network, from: Int, until: Int): Unit =
    eachBelow(layers): layer =>
      val (ins, outs) = (widths(layer), widths(layer + 1))
      val out         = activations(layer + 1)
      eachFrom(from, until): row =>
        System.arraycopy(network.parameters, network.biasesAt(layer), out, row * outs, outs)
      val (x, weightsAt) = (activations(layer), network.weightsAt(layer))
      DenseKernel.addProduct(
        until - from,
        ins,
        outs,
        x,
        from * ins,
        ins,
        1,
        network.parameters,
        weightsAt,
        out,
        from * outs
      )
      if layer < layers - 1 then
        eachFrom(from * outs, until * outs): i =>
          out(i) = Math.max(out(i), 0f)

  /** Computes derivatives after [[forward]].
    *
    * @param gradient the rows' derivatives are added to it, in the parameters' order
    */
  def backward(network: Network, from: Int, until: Int, gradient: Array[Float]): Unit =
    back(network, from, until): layer =>
      val (ins, outs) = (widths(layer), widths(layer + 1))
      val error       = errors(layer + 1)
      val at          = network.weightsAt(layer)
      // Weights: inputs, turned, times errors.
      DenseKernel.addProduct(
        ins,
        until - from,
        outs,
        activations(layer),
        from * ins,
        1,
        ins,
        error,
        from * outs,
        gradient,
        at
      )
      val biases = network.biasesAt(layer)
      eachFrom(from, until): row =>
        eachBelow(outs): j =>
          gradient(biases + j) += error(row * outs + j)

  /** Computes the derivatives of the inputs only. */
  def backwardToInput(network: Network, from: Int, until: Int): Unit =
    back(network, from, until)(_ => ())
    toInputs(network, 0, from, until)

  private def back(network: Network, from: Int, until: Int)(onLayer: Int => Unit): Unit =
    var layer = layers - 1
    while layer >= 0 do
      onLayer(layer)
      if layer > 0 then
        toInputs(network, layer, from, until)
        val (x, into) = (activations(layer), errors(layer))
        eachFrom(from * widths(layer), until * widths(layer)): i =>
          if x(i) <= 0 then into(i) = 0
      layer -= 1

  private def toInputs(network: Network, layer: Int, from: Int, until: Int): Unit =
    val (ins, outs) = (widths(layer), widths(layer + 1))
    val into        = errors(layer)
    java.util.Arrays.fill(into, from * ins, until * ins, 0f)
    val weights = network.weightsByOutput(layer)
    DenseKernel.addProduct(
      until - from,
      outs,
      ins,
      errors(layer + 1),
      from * outs,
      outs,
      1,
      weights,
      0,
      into,
      from * ins
    )
