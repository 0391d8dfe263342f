package skein.policy

/** A trained policy. The inputs of its network are the observation of [[LearnerSpace.Level]], scaled; its one
  * output, between −1 and 1, is the turn.
  *
  * A decision allocates two arrays as wide as the widest layer, and one for the observation.
  *
  * @param parameters weights and biases in the order of [[NeuralShape]]
  * @param turnRateRadPerS maximum turn rate until the next decision
  * @param turnRad maximum turn of one decision, whatever the time since the last
  */
final case class LearnedPolicy(
    shape: NeuralShape,
    parameters: Vector[Double],
    turnRateRadPerS: Double,
    turnRad: Double
) extends HeadingPolicy.Memoryless:
  private val network = LearnedNetwork(shape, parameters, LearnerSpace.Level)

  def heading(seen: PlanarObservation): Double =
    seen.ownHeadingRad + share(seen) * (turnRateRadPerS * seen.elapsedS + turnRad)

  /** The network's output: the share of the largest turn, between −1 and 1, positive to the right. */
  def share(seen: PlanarObservation): Double = network.shares(seen.fromOwnHeading)(0)

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

/** The network of a trained policy: scales observations, and squashes its outputs to −1 to 1. */
private final class LearnedNetwork(shape: NeuralShape, parameters: Vector[Double], space: LearnerSpace):
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

  /** The shares of an action for an observation, in the order of [[LearnerSpace]]. */
  def shares(observed: Array[Double]): Array[Double] =
    val input = network.scratch
    var i     = 0
    while i < scales.length do
      input(i) = observed(i) / scales(i)
      i += 1
    network.outputs(input)
