package skein.policy

/** A small network of neurons with tanh. It sees the opponent in the own frame (the own heading is ahead): position over
  * [[NeuralPolicy.LengthM]] and relative velocity over [[NeuralPolicy.SpeedMps]], each ahead and to the right; its one
  * output, in −1 to 1, times the turn rate is how fast it turns.
  *
  * Allocates two arrays as wide as its widest layer at a decision; by lanes the network has no arrays.
  *
  * @param parameters
  *   as [[NeuralShape]] lays them out
  * @param turnRateRadPerS
  *   the most that it turns
  */
final case class NeuralPolicy(shape: NeuralShape, parameters: Vector[Double], turnRateRadPerS: Double = 1.0)
    extends Policy:
  require(
    parameters.size == shape.parameters,
    s"a network of $shape has ${shape.parameters} parameters, got ${parameters.size}"
  )

  private val weights = parameters.toArray
  private val widths  = shape.widths.toArray
  private val widest  = shape.widest

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
    val cos    = StrictMath.cos(ownHeadingRad)
    val sin    = StrictMath.sin(ownHeadingRad)
    var input  = Array.ofDim[Double](widest)
    var output = Array.ofDim[Double](widest)
    input(0) = (dxM * cos + dyM * sin) / NeuralPolicy.LengthM
    input(1) = (dyM * cos - dxM * sin) / NeuralPolicy.LengthM
    input(2) = (dvxMps * cos + dvyMps * sin) / NeuralPolicy.SpeedMps
    input(3) = (dvyMps * cos - dvxMps * sin) / NeuralPolicy.SpeedMps
    var at    = 0
    var layer = 1
    while layer < widths.length do
      var neuron = 0
      while neuron < widths(layer) do
        var sum = 0.0
        var i   = 0
        while i < widths(layer - 1) do
          sum += weights(at) * input(i)
          at += 1
          i += 1
        output(neuron) = StrictMath.tanh(sum + weights(at))
        at += 1
        neuron += 1
      val spare = input
      input = output
      output = spare
      layer += 1
    turnRateRadPerS * input(0)

object NeuralPolicy:
  /** Distances of about this much are seen best, m. */
  val LengthM = 20.0

  /** The same for velocities, m/s. */
  val SpeedMps = 10.0

/** How many neurons each hidden layer has. Parameters are laid out layer by layer, neuron by neuron: a weight per input,
  * then the bias.
  */
final case class NeuralShape(hidden: Vector[Int]):
  require(
    hidden.forall(width =>
      width >= 1 && width <= NeuralShape.MostWidth
    ) && hidden.sizeIs <= NeuralShape.MostLayers,
    s"expected at most ${NeuralShape.MostLayers} hidden layers of 1 to ${NeuralShape.MostWidth} neurons, came $this"
  )

  /** Of all layers, the inputs first. */
  def widths: Vector[Int] = NeuralShape.Inputs +: hidden :+ 1

  def widest: Int = widths.max

  /** How many numbers decide a network. */
  def parameters: Int = widths.zip(widths.drop(1)).map((inputs, neurons) => neurons * (inputs + 1)).sum

  /** A name per parameter: `weight-LAYER-NEURON-INPUT` or `bias-LAYER-NEURON`, from 1. */
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

  /** `8x8`: the hidden layers' widths. */
  def parse(text: String): Either[String, NeuralShape] =
    val widths = text.split("x", -1).toVector.map(_.toIntOption)
    if widths.sizeIs <= MostLayers && widths.forall(_.exists(width => width >= 1 && width <= MostWidth)) then
      Right(NeuralShape(widths.flatten))
    else
      Left(
        s"expected up to $MostLayers widths of hidden layers from 1 to $MostWidth, for example 8x8, came '$text'"
      )
