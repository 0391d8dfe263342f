package skein.onnx

/** An ONNX model, limited to the needs of small dense networks. Source: onnx.proto3 of ONNX 1.23, by its
  * field numbers.
  *
  * @param metadata notes of the program that wrote the model, by key
  */
final case class OnnxGraph(
    nodes: Vector[OnnxGraph.Node],
    constants: Map[String, OnnxGraph.Tensor],
    inputs: Vector[OnnxGraph.Port],
    outputs: Vector[OnnxGraph.Port],
    metadata: Map[String, String] = Map.empty
)

object OnnxGraph:
  val Float32 = 1
  val Float16 = 10
  val Float64 = 11

  /** An operation of the graph.
    *
    * @param inputs names of the input values; an empty name means that the input is omitted
    * @param attributes the operation's attributes, with their names
    */
  final case class Node(
      operator: String,
      inputs: Vector[String],
      outputs: Vector[String],
      attributes: Map[String, Attribute] = Map.empty
  )

  enum Attribute:
    case Number(value: Double)
    case Whole(value: Long)
    case Numbers(values: Vector[Double])
    case Constant(value: Tensor)
    case Other

  /** A constant array of numbers.
    *
    * @param values the elements, row by row
    */
  final case class Tensor(shape: Vector[Int], values: Vector[Double])

  /** An input or output of the model.
    *
    * @param element number of the element type
    * @param shape lengths, each None if any length is allowed; None if the model does not state the shape
    */
  final case class Port(name: String, element: Int, shape: Option[Vector[Option[Int]]]):
    def text: String =
      s"'$name' of " + shape.fold("a shape that is not told")(
        _.map(_.fold("any")(_.toString)).mkString("(", ", ", ")")
      )
