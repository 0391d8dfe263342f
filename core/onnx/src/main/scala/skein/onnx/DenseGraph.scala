package skein.onnx

import skein.onnx.OnnxGraph.*
import skein.policy.{Activation, LearnedPolicy, LearnerSpace, NeuralShape}

/** Converts between dense networks and ONNX graphs. A graph's input is the observation in SI units; its
  * output is the action, between −1 and 1 ([[LearnerSpace]]).
  */
private[onnx] object DenseGraph:
  /** A network with its parameters, in the order of [[NeuralShape]]. */
  type Network = (NeuralShape, Vector[Double])

  /** The supported operators; those that return their input unchanged are first. */
  val operators: Vector[String] = Vector(
    "Identity",
    "Cast",
    "Dropout",
    "Flatten",
    "Reshape",
    "Squeeze",
    "Unsqueeze",
    "Constant",
    "Transpose",
    "Gemm",
    "MatMul",
    "Add",
    "Sub",
    "Mul",
    "Div",
    "Relu",
    "Elu",
    "Tanh",
    "Sigmoid",
    "Clip"
  )

  /** Interprets a graph as the network of a trained policy. Multiplications, additions and divisions between
    * two layers are folded into their weights, in doubles.
    *
    * @return Left says why the graph is not such a network
    */
  def network(graph: OnnxGraph, space: LearnerSpace): Either[String, Network] =
    try
      val start: Value = Flow(Vector.empty, Affine.scaled(space.scales))
      val constants    = graph.constants.map((name, tensor) => name -> Fixed(tensor))
      val values       = graph.nodes.foldLeft(constants + (graph.inputs.head.name -> start)): (known, node) =>
        val inputs = node.inputs.map(name =>
          if name.isEmpty then None
          else
            Some(known.getOrElse(name, throw NotDense(s"'$name' comes from nowhere before ${node.operator}")))
        )
        known ++ node.outputs.headOption.map(_ -> value(node, inputs))
      values.get(graph.outputs.head.name) match
        case Some(flow: Flow) => Right(flow.network(space))
        case _ => Left(s"its output '${graph.outputs.head.name}' does not depend upon its input")
    catch case reason: NotDense => Left(reason.getMessage)

  private final class NotDense(reason: String) extends RuntimeException(reason)

  private sealed trait Value
  private final case class Fixed(tensor: Tensor) extends Value

  /** Intermediate result while following the graph: the layers found so far, and sums still without an
    * activation.
    */
  private final case class Flow(layers: Vector[(Affine, Activation)], sums: Affine) extends Value:
    def activated(kind: Activation): Flow =
      Flow(layers :+ (sums, kind), Affine.scaled(Vector.fill(sums.rows)(1.0)))

    /** The complete network. An output without a limiting activation is clipped to −1 and 1. */
    def network(space: LearnerSpace): Network =
      if sums.rows != space.outputs then
        throw NotDense(s"expected ${space.outputs} outputs, got ${sums.rows}")
      val isSquashed = layers.lastOption.exists(_._2.squashes) && sums.isIdentity
      val all        = if isSquashed then layers else layers :+ (sums, Activation.Clip)
      val hidden     = all.init.map(_._1.rows)
      val widest     = hidden.maxOption.getOrElse(0)
      if hidden.sizeIs > NeuralShape.MostLayers || widest > NeuralShape.MostWidth then
        throw NotDense(
          s"expected at most ${NeuralShape.MostLayers} hidden layers of at most " +
            s"${NeuralShape.MostWidth} neurons, got ${hidden.mkString("x")}"
        )
      (NeuralShape(hidden, space.inputs, all.map(_._2), space.outputs), all.flatMap(_._1.parameters))

  /** Sums of inputs, each with a bias.
    *
    * @param weights weights by sum, then by input
    */
  private final case class Affine(weights: Vector[Vector[Double]], biases: Vector[Double]):
    def rows: Int = weights.size

    def parameters: Vector[Double] = weights.zip(biases).flatMap(_ :+ _)

    def isIdentity: Boolean = this == Affine.scaled(Vector.fill(rows)(1.0))

    def into(next: Affine): Affine =
      if next.weights.exists(_.size != rows) then
        throw NotDense(s"expected weights of $rows inputs, got ${next.weights.head.size}")
      val columns = weights.transpose
      val summed  = next.weights.map(row => columns.map(column => dot(row, column)))
      Affine(summed, next.weights.zip(next.biases).map((row, bias) => dot(row, biases) + bias))

    private def dot(one: Vector[Double], other: Vector[Double]) =
      var sum = 0.0
      for i <- one.indices do sum += one(i) * other(i)
      sum

    def each(weight: (Double, Int) => Double, bias: (Double, Int) => Double): Affine =
      Affine(
        weights.zipWithIndex.map((row, index) => row.map(weight(_, index))),
        biases.zipWithIndex.map(bias(_, _))
      )

  private object Affine:
    def scaled(by: Vector[Double]): Affine =
      Affine(
        Vector.tabulate(by.size, by.size)((i, j) => if i == j then by(i) else 0.0),
        Vector.fill(by.size)(0.0)
      )

  private def value(node: Node, inputs: Vector[Option[Value]]): Value =
    def input(index: Int)                       = inputs.lift(index).flatten
    def attribute(name: String)                 = node.attributes.get(name)
    def number(name: String, otherwise: Double) = attribute(name) match
      case Some(Attribute.Number(value)) => value
      case _                             => otherwise
    def whole(name: String, otherwise: Long) = attribute(name) match
      case Some(Attribute.Whole(value)) => value
      case _                            => otherwise
    def not(what: String) = throw NotDense(s"operator ${node.operator}: $what")
    def flow(index: Int)  = input(index) match
      case Some(flow: Flow) => flow
      case _                => not("it is not where a dense network has it")
    def fixed(index: Int): Tensor = input(index) match
      case Some(Fixed(tensor)) => tensor
      case _                   => not("its weights are no constants")

    node.operator match
      case "Constant" =>
        node.attributes.values.headOption match
          case Some(Attribute.Constant(tensor)) => Fixed(tensor)
          case Some(Attribute.Number(value))    => Fixed(Tensor(Vector.empty, Vector(value)))
          case Some(Attribute.Whole(value))     => Fixed(Tensor(Vector.empty, Vector(value.toDouble)))
          case Some(Attribute.Numbers(values))  => Fixed(Tensor(Vector(values.size), values))
          case _                                => not("its value is not understood")
      case "Identity" | "Dropout" => input(0).getOrElse(not("it has no input"))
      case "Cast"                 =>
        if !Set[Long](Float32, Float64, 10, 16)(whole("to", Float32)) && input(0).exists(_.isInstanceOf[Flow])
        then
          not("to another type than floats")
        input(0).getOrElse(not("it has no input"))
      case "Flatten"               => flow(0)
      case "Squeeze" | "Unsqueeze" =>
        flow(0)
      case "Reshape" =>
        val rows  = flow(0).sums.rows
        val shape = fixed(1).values
        if shape.sizeIs > 2 || !(shape.lastOption.exists(last => last == rows || last == -1)) then
          not(
            s"expected one that keeps $rows numbers in a row, got " +
              s"${shape.map(_.toLong).mkString("(", ", ", ")")}"
          )
        flow(0)
      case "Transpose" =>
        Fixed(transposed(fixed(0)).getOrElse(not("of another thing than a table of weights")))
      case "Gemm" =>
        if whole("transA", 0) != 0 then not("with a transposed input")
        val table  = if whole("transB", 0) != 0 then Some(fixed(1)) else transposed(fixed(1))
        val alpha  = number("alpha", 1)
        val beta   = number("beta", 1)
        val rows   = table.map(table_).getOrElse(not("its weights are no table"))
        val biases = input(2).fold(Vector.fill(rows.size)(0.0))(_ => spread(fixed(2), rows.size, not))
        val sums   = flow(0).sums.into(Affine(rows.map(_.map(alpha * _)), biases.map(beta * _)))
        flow(0).copy(sums = sums)
      case "MatMul" =>
        val rows = transposed(fixed(1)).map(table_).getOrElse(not("its weights are no table"))
        flow(0).copy(sums = flow(0).sums.into(Affine(rows, Vector.fill(rows.size)(0.0))))
      case "Add" | "Mul" | "Sub" | "Div" =>
        (input(0), input(1)) match
          case (Some(flow: Flow), Some(Fixed(tensor))) => by(node.operator, flow, tensor, not)
          case (Some(Fixed(tensor)), Some(flow: Flow)) if node.operator == "Add" || node.operator == "Mul" =>
            by(node.operator, flow, tensor, not)
          case _ => not("expected one with a constant behind")
      case "Relu" => flow(0).activated(Activation.Relu)
      case "Elu"  =>
        if number("alpha", 1) != 1 then not(s"expected an alpha of 1, got ${number("alpha", 1)}")
        flow(0).activated(Activation.Elu)
      case "Tanh"    => flow(0).activated(Activation.Tanh)
      case "Sigmoid" =>
        val halved = flow(0).copy(sums = flow(0).sums.each((w, _) => w / 2, (b, _) => b / 2))
        val tanh   = halved.activated(Activation.Tanh)
        tanh.copy(sums = tanh.sums.each((w, _) => w / 2, (b, _) => b / 2 + 0.5))
      case "Clip" =>
        def bound(index: Int, name: String, otherwise: Double) =
          if inputs.lift(index).flatten.isEmpty then number(name, otherwise)
          else fixed(index).values.headOption.getOrElse(not("its bounds are no numbers"))
        val (least, most) =
          (bound(1, "min", Double.NegativeInfinity), bound(2, "max", Double.PositiveInfinity))
        if least == 0 && most.isInfinite then flow(0).activated(Activation.Relu)
        else if least.isInfinite || most.isInfinite || !(least < most) then
          not(s"expected two bounds, got $least and $most")
        else
          val (middle, half) = ((least + most) / 2, (most - least) / 2)
          val within         =
            flow(0).copy(sums = flow(0).sums.each((w, _) => w / half, (b, _) => (b - middle) / half))
          val clip = within.activated(Activation.Clip)
          clip.copy(sums = clip.sums.each((w, _) => w * half, (b, _) => b * half + middle))
      case other => throw NotDense(s"operator $other is none of ${operators.mkString(", ")}")

  private def table_(tensor: Tensor): Vector[Vector[Double]] = tensor.values.grouped(tensor.shape(1)).toVector

  private def transposed(tensor: Tensor): Option[Tensor] = tensor.shape match
    case Vector(rows, columns) if rows > 0 && columns > 0 =>
      Some(Tensor(Vector(columns, rows), table_(tensor).transpose.flatten))
    case _ => None

  /** One value for each sum; a tensor with a single value is repeated. */
  private def spread(tensor: Tensor, rows: Int, not: String => Nothing): Vector[Double] =
    if tensor.values.size == 1 then Vector.fill(rows)(tensor.values.head)
    else if tensor.values.size == rows && tensor.shape.last == rows then tensor.values
    else not(s"expected $rows numbers, got ${tensor.shape.mkString(" × ")}")

  private def by(operator: String, flow: Flow, tensor: Tensor, not: String => Nothing): Flow =
    val numbers = spread(tensor, flow.sums.rows, not)
    flow.copy(sums = operator match
      case "Add" => flow.sums.each((weight, _) => weight, (bias, row) => bias + numbers(row))
      case "Sub" => flow.sums.each((weight, _) => weight, (bias, row) => bias - numbers(row))
      case "Mul" => flow.sums.each((weight, row) => weight * numbers(row), (bias, row) => bias * numbers(row))
      case _     =>
        flow.sums.each((weight, row) => quotient(weight, numbers(row)), (bias, row) => bias / numbers(row)))

  /** The quotient of two numbers, but 1 if they are equal as 32-bit floats, so that Skein's own networks are
    * restored bit for bit although files store scales as such floats.
    */
  private def quotient(one: Double, by: Double): Double = if one.toFloat == by.toFloat then 1 else one / by

  /** Writes a policy's network as a graph: the scales, then a `Gemm` and an activation for each layer. */
  def graph(policy: LearnedPolicy, metadata: Map[String, String]): OnnxGraph =
    val shape  = policy.shape
    val widths = shape.widths
    val starts =
      widths.zip(widths.drop(1)).map((inputs, neurons) => neurons * (inputs + 1)).scanLeft(0)(_ + _)
    val layers  = shape.activations.indices.toVector
    val scales  = "scales" -> Tensor(Vector(shape.inputs), policy.space.scales)
    val weights = layers.flatMap: layer =>
      val rows = policy.parameters.slice(starts(layer), starts(layer + 1)).grouped(widths(layer) + 1).toVector
      Vector(
        s"weights-${layer + 1}" -> Tensor(Vector(widths(layer + 1), widths(layer)), rows.flatMap(_.init)),
        s"biases-${layer + 1}"  -> Tensor(Vector(widths(layer + 1)), rows.map(_.last))
      )
    val bounds = Option
      .when(shape.activations.contains(Activation.Clip))(
        Vector(
          "least" -> Tensor(Vector.empty, Vector(-1.0)),
          "most"  -> Tensor(Vector.empty, Vector(1.0))
        )
      )
      .toVector
      .flatten
    val scaled = Node("Div", Vector(Input, "scales"), Vector("scaled"))
    val nodes  = layers.flatMap: layer =>
      val from = if layer == 0 then "scaled" else s"layer-$layer"
      val sums = s"sums-${layer + 1}"
      val into = if layer == layers.last then Output else s"layer-${layer + 1}"
      val gemm = Node(
        "Gemm",
        Vector(from, s"weights-${layer + 1}", s"biases-${layer + 1}"),
        Vector(sums),
        Map("transB" -> Attribute.Whole(1))
      )
      val activated = shape.activations(layer) match
        case Activation.Relu => Node("Relu", Vector(sums), Vector(into))
        case Activation.Tanh => Node("Tanh", Vector(sums), Vector(into))
        case Activation.Elu  => Node("Elu", Vector(sums), Vector(into))
        case Activation.Clip => Node("Clip", Vector(sums, "least", "most"), Vector(into))
      Vector(gemm, activated)
    OnnxGraph(
      scaled +: nodes,
      (scales +: (weights ++ bounds)).toMap,
      Vector(Port(Input, Float32, Some(Vector(None, Some(shape.inputs))))),
      Vector(Port(Output, Float32, Some(Vector(None, Some(shape.outputs))))),
      metadata
    )

  private val Input  = "observation"
  private val Output = "action"
