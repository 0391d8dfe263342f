package skein.policy

/** The layers of a network. Parameters are ordered layer by layer, neuron by neuron: a weight per input, then
  * the bias.
  *
  * @param hidden number of neurons in each hidden layer
  * @param activations the activation of each hidden layer, and of the outputs
  */
final case class NeuralShape(
    hidden: Vector[Int],
    inputs: Int,
    activations: Vector[Activation],
    outputs: Int = 1
):
  require(
    hidden.forall(width =>
      width >= 1 && width <= NeuralShape.MostWidth
    ) && hidden.sizeIs <= NeuralShape.MostLayers && activations.sizeIs == hidden.size + 1,
    s"expected at most ${NeuralShape.MostLayers} hidden layers of " +
      s"1 to ${NeuralShape.MostWidth} neurons, got $this"
  )

  def widths: Vector[Int] = inputs +: hidden :+ outputs

  def widest: Int = widths.max

  /** Number of parameters of a network of this shape. */
  def parameters: Int = widths.zip(widths.drop(1)).map((inputs, neurons) => neurons * (inputs + 1)).sum

  /** A name for each parameter: `weight-LAYER-NEURON-INPUT` or `bias-LAYER-NEURON`, counted from 1. */
  def names: Vector[String] =
    for
      layer  <- (1 until widths.size).toVector
      neuron <- 1 to widths(layer)
      name <- (1 to widths(layer - 1)).map(input => s"weight-$layer-$neuron-$input") :+ s"bias-$layer-$neuron"
    yield name

  override def toString: String = if hidden.isEmpty then "no hidden layer" else hidden.mkString("x")

object NeuralShape:
  val Inputs     = 4
  val MostWidth  = 256
  val MostLayers = 8

  def apply(hidden: Vector[Int]): NeuralShape =
    NeuralShape(hidden, Inputs, Vector.fill(hidden.size + 1)(Activation.Tanh))

  /** Reads the widths of the hidden layers, such as `8x8`. */
  def parse(text: String): Either[String, NeuralShape] =
    val widths = text.split("x", -1).toVector.map(_.toIntOption)
    if widths.sizeIs <= MostLayers && widths.forall(_.exists(isWidth)) then Right(NeuralShape(widths.flatten))
    else
      Left(
        s"expected up to $MostLayers widths of hidden layers from 1 " +
          s"to $MostWidth, for example 8x8, got '$text'"
      )

  private[policy] def isWidth(width: Int): Boolean = width >= 1 && width <= MostWidth
