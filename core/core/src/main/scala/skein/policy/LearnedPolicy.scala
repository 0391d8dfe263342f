package skein.policy

/** A trained policy. The inputs of its network are the observation of its space, scaled; its outputs,
  * squashed to −1 to 1, are the action.
  *
  * A decision allocates two arrays as wide as the widest layer, and one for the observation.
  *
  * @param parameters weights and biases in the order of [[NeuralShape]]
  */
final case class LearnedPolicy(
    shape: NeuralShape,
    parameters: Vector[Double],
    turnRateRadPerS: Double,
    turnRad: Double,
    climbMps: Double = 0
) extends SharesPolicy:
  val space: LearnerSpace = LearnerSpace.of(shape)
  require(
    shape.inputs == space.inputs && shape.outputs == space.outputs,
    s"a learned policy has ${space.inputs} inputs and ${space.outputs} outputs, got ${shape.inputs} and " +
      s"${shape.outputs}"
  )
  require(
    shape.activations.last.squashes,
    s"a learned policy's output is squashed by tanh or clipped, got ${shape.activations.last.label}"
  )

  private val network = DenseNetwork(shape, parameters)
  private val scales  = space.scales.toArray

  def shares(observed: Array[Double]): Array[Double] =
    val input = network.scratch
    var i     = 0
    while i < scales.length do
      input(i) = observed(i) / scales(i)
      i += 1
    network.outputs(input)

object LearnedPolicy:
  /** The shape of the networks that learners train: rectifiers in hidden layers, tanh at the outputs. */
  def shape(hidden: Vector[Int], space: LearnerSpace = LearnerSpace.Level): NeuralShape =
    ofSpace(hidden, Vector.fill(hidden.size)(Activation.Relu) :+ Activation.Tanh, space)

  private def ofSpace(hidden: Vector[Int], activations: Vector[Activation], space: LearnerSpace) =
    NeuralShape(hidden, space.inputs, activations, space.outputs)

  /** The default limits of a role's turns: rad/s until the next decision, and rad per decision.
    *
    * @param rateRadPerS maximum turn rate of a pursuer
    */
  def mostTurn(role: Role, rateRadPerS: Double): Vector[Double] =
    if role == Role.Pursuer then Vector(rateRadPerS, 0.0) else Vector(0.0, math.Pi)

  /** The label of a shape: `64x64` has rectifiers, and tanh at the output. A different activation follows the
    * layer's width; that of the output follows a colon: `64tanhx64tanh:clip`.
    */
  def label(shape: NeuralShape): String =
    val hidden = shape.hidden.zip(shape.activations).map: (width, activation) =>
      s"$width${if activation == Activation.Relu then "" else activation.label}"
    hidden.mkString("x") + (if shape.activations.last == Activation.Tanh then ""
                            else s":${shape.activations.last.label}")

  /** Reads the text form of [[label]], such as `64x64`. */
  def parse(text: String, space: LearnerSpace): Either[String, NeuralShape] =
    def layer(text: String) =
      val (width, activation) = text.span(_.isDigit)
      for
        number <- width.toIntOption.filter(NeuralShape.isWidth)
        kind   <- if activation.isEmpty then Some(Activation.Relu) else named(activation)
      yield (number, kind)
    val (hidden, output) = text.span(_ != ':')
    val layers           = if hidden.isEmpty then Vector.empty else hidden.split("x", -1).toVector.map(layer)
    val last             = if output.isEmpty then Some(Activation.Tanh) else named(output.tail)
    last.filter(
      _.squashes && layers.sizeIs <= NeuralShape.MostLayers && layers.forall(_.isDefined)
    ) match
      case Some(kind) =>
        Right(ofSpace(layers.flatten.map(_._1), layers.flatten.map(_._2) :+ kind, space))
      case None =>
        Left(
          s"expected up to ${NeuralShape.MostLayers} widths of hidden layers from 1 to " +
            s"${NeuralShape.MostWidth}, each with relu, tanh, clip or elu behind it, and :tanh or " +
            s":clip of the output, for example 64x64 or 64tanhx64tanh:clip, got '$text'"
        )

  private def named(text: String) = Activation.values.find(_.label == text)
