package skein.onnx

import com.google.protobuf.{ByteString, CodedInputStream, CodedOutputStream, WireFormat}
import java.io.{ByteArrayOutputStream, IOException}
import java.nio.{ByteBuffer, ByteOrder}
import scala.collection.mutable
import skein.onnx.OnnxGraph.*

/** Reads and writes ONNX files, which are protocol buffers, by their field numbers. */
object OnnxFormat:
  private val IrVersion = 8L
  private val Opset     = 13L

  /** Reads external tensor data, from file name, offset and length, in bytes. */
  type Beside = (String, Long, Long) => Either[String, Array[Byte]]

  /** Reads a model. Left says why the bytes are not a model. */
  def read(bytes: Array[Byte], beside: Beside): Either[String, OnnxGraph] =
    try
      val parts    = Parts(beside)
      val graphs   = mutable.Buffer.empty[OnnxGraph]
      val metadata = mutable.Map.empty[String, String]
      each(bytes):
        case (7, in)  => graphs += parts.graph(in.readByteArray())
        case (14, in) => metadata += entry(in.readByteArray())
      graphs.lastOption.map(_.copy(metadata = metadata.toMap)).toRight("it has no graph")
    catch
      case mistake: Mistake                             => Left(mistake.getMessage)
      case damaged: (IOException | ArithmeticException) => Left(s"it is damaged: ${damaged.getMessage}")

  private final class Mistake(reason: String) extends RuntimeException(reason)

  /** Visits the fields of a message, and skips those for which `field` is not defined. */
  private def each(bytes: Array[Byte])(field: PartialFunction[(Int, CodedInputStream), Unit]): Unit =
    val in  = CodedInputStream.newInstance(bytes)
    var tag = in.readTag()
    while tag != 0 do
      field.applyOrElse((WireFormat.getTagFieldNumber(tag), in), _ => in.skipField(tag): Unit)
      tag = in.readTag()

  /** Reads a single number or several packed ones, since programs write either.
    *
    * @param size bytes of a single number; 0 if it varies
    */
  private def several(in: CodedInputStream, size: Int)(one: CodedInputStream => Double): Vector[Double] =
    if WireFormat.getTagWireType(in.getLastTag) != WireFormat.WIRETYPE_LENGTH_DELIMITED then Vector(one(in))
    else
      val bytes = in.readByteArray()
      if size > 0 && bytes.length % size != 0 then
        throw Mistake(s"it is damaged: numbers of $size bytes each in ${bytes.length} bytes")
      val packed = CodedInputStream.newInstance(bytes)
      val values = Vector.newBuilder[Double]
      while !packed.isAtEnd do values += one(packed)
      values.result()

  private final class Parts(beside: Beside):
    def graph(bytes: Array[Byte]): OnnxGraph =
      val nodes           = Vector.newBuilder[Node]
      val constants       = mutable.Map.empty[String, Tensor]
      val inputs, outputs = Vector.newBuilder[Port]
      each(bytes):
        case (1, in)  => nodes += node(in.readByteArray())
        case (5, in)  => constants += tensor(in.readByteArray())
        case (11, in) => inputs += port(in.readByteArray())
        case (12, in) => outputs += port(in.readByteArray())
      // Before IR version 4, constants were also inputs.
      OnnxGraph(
        nodes.result(),
        constants.toMap,
        inputs.result().filterNot(port => constants.contains(port.name)),
        outputs.result()
      )

    private def node(bytes: Array[Byte]): Node =
      var operator, domain = ""
      val inputs, outputs  = Vector.newBuilder[String]
      val attributes       = mutable.Map.empty[String, Attribute]
      each(bytes):
        case (1, in) => inputs += in.readStringRequireUtf8()
        case (2, in) => outputs += in.readStringRequireUtf8()
        case (4, in) => operator = in.readStringRequireUtf8()
        case (5, in) => attributes += attribute(in.readByteArray())
        case (7, in) => domain = in.readStringRequireUtf8()
      val name = if domain.isEmpty || domain == "ai.onnx" then operator else s"$domain.$operator"
      Node(name, inputs.result(), outputs.result(), attributes.toMap)

    private def attribute(bytes: Array[Byte]): (String, Attribute) =
      var name             = ""
      var value: Attribute = Attribute.Other
      val many             = Vector.newBuilder[Double]
      each(bytes):
        case (1, in) => name = in.readStringRequireUtf8()
        case (2, in) => value = Attribute.Number(in.readFloat())
        case (3, in) => value = Attribute.Whole(in.readInt64())
        case (5, in) => value = Attribute.Constant(tensor(in.readByteArray())._2)
        case (7, in) => many ++= several(in, 4)(_.readFloat().toDouble)
        case (8, in) => many ++= several(in, 0)(_.readInt64().toDouble)
      val numbers = many.result()
      (name, if numbers.isEmpty then value else Attribute.Numbers(numbers))

    private def tensor(bytes: Array[Byte]): (String, Tensor) =
      val shape   = Vector.newBuilder[Int]
      val numbers = Vector.newBuilder[Double]
      val other   = mutable.Map.empty[String, String]
      var name    = ""
      var element = 0
      var raw     = Option.empty[Array[Byte]]
      each(bytes):
        case (1, in)  => shape ++= several(in, 0)(_.readInt64().toDouble).map(_.toInt)
        case (2, in)  => element = in.readInt32()
        case (4, in)  => numbers ++= several(in, 4)(_.readFloat().toDouble)
        case (5, in)  => numbers ++= several(in, 0)(_.readInt32().toDouble)
        case (7, in)  => numbers ++= several(in, 0)(_.readInt64().toDouble)
        case (8, in)  => name = in.readStringRequireUtf8()
        case (9, in)  => raw = Some(in.readByteArray())
        case (10, in) => numbers ++= several(in, 8)(_.readDouble())
        case (13, in) => other += entry(in.readByteArray())
      val dimensions = shape.result()
      val count      = dimensions.foldLeft(1L)((count, length) => Math.multiplyExact(count, length.toLong))
      for file <- other.get("location") do
        def number(key: String, otherwise: Long) = other.get(key).flatMap(_.toLongOption).getOrElse(otherwise)
        val read                                 = beside(file, number("offset", 0), number("length", -1))
        raw = Some(read.fold(reason => throw Mistake(reason), identity))
      // Half floats that are not raw are stored by their bits (onnx.proto3, TensorProto.int32_data).
      val listed = numbers.result()
      val plain  =
        if element != Float16 then listed
        else listed.map(bits => java.lang.Float.float16ToFloat(bits.toShort).toDouble)
      val values = raw.fold(plain)(unpacked(element, _))
      if values.size != count then
        throw Mistake(
          s"tensor '$name': expected ${dimensions.mkString(" × ")} numbers, got ${values.size}"
        )
      (name, Tensor(dimensions, values))

  /** The values of a tensor. Only element types that can represent a network's weights are supported. */
  private def unpacked(element: Int, raw: Array[Byte]): Vector[Double] =
    val buffer                         = ByteBuffer.wrap(raw).order(ByteOrder.LITTLE_ENDIAN)
    def all(size: Int)(one: => Double) = Vector.fill(raw.length / size)(one)
    element match
      case Float32 => all(4)(buffer.getFloat)
      case Float64 => all(8)(buffer.getDouble)
      case 6       => all(4)(buffer.getInt)
      case 7       => all(8)(buffer.getLong.toDouble)
      case Float16 => all(2)(java.lang.Float.float16ToFloat(buffer.getShort))
      case _       => all(1)(buffer.get)

  private def port(bytes: Array[Byte]): Port =
    var name    = ""
    var element = 0
    var shape   = Option.empty[Vector[Option[Int]]]
    each(bytes):
      case (1, in) => name = in.readStringRequireUtf8()
      case (2, in) =>
        each(in.readByteArray()):
          case (1, tensor) =>
            each(tensor.readByteArray()):
              case (1, told) => element = told.readInt32()
              case (2, told) => shape = Some(dimensions(told.readByteArray()))
    Port(name, element, shape)

  private def dimensions(bytes: Array[Byte]): Vector[Option[Int]] =
    val lengths = Vector.newBuilder[Option[Int]]
    each(bytes):
      case (1, in) =>
        var length = Option.empty[Int]
        each(in.readByteArray()):
          case (1, told) => length = Some(told.readInt64()).filter(_ >= 0).map(_.toInt)
        lengths += length
    lengths.result()

  private def entry(bytes: Array[Byte]): (String, String) =
    var key, value = ""
    each(bytes):
      case (1, in) => key = in.readStringRequireUtf8()
      case (2, in) => value = in.readStringRequireUtf8()
    (key, value)

  /** Writes a model. Values become 32-bit floats; those in shapes and indices are not written. */
  def write(graph: OnnxGraph): Array[Byte] = message: out =>
    out.writeInt64(1, IrVersion)
    out.writeString(2, "skein")
    nested(out, 7): part =>
      graph.nodes.foreach(node => nested(part, 1)(written(node, _)))
      part.writeString(2, "policy")
      graph.constants.toVector.sortBy(_._1).foreach((name, tensor) =>
        nested(part, 5)(written(name, tensor, _))
      )
      graph.inputs.foreach(port => nested(part, 11)(written(port, _)))
      graph.outputs.foreach(port => nested(part, 12)(written(port, _)))
    nested(out, 8): opset =>
      opset.writeString(1, "")
      opset.writeInt64(2, Opset)
    graph.metadata.toVector.sorted.foreach: (key, value) =>
      nested(out, 14): entry =>
        entry.writeString(1, key)
        entry.writeString(2, value)

  private def written(node: Node, out: CodedOutputStream): Unit =
    node.inputs.foreach(out.writeString(1, _))
    node.outputs.foreach(out.writeString(2, _))
    out.writeString(4, node.operator)
    node.attributes.toVector.sortBy(_._1).foreach:
      case (name, Attribute.Whole(value)) =>
        nested(out, 5): attribute =>
          attribute.writeString(1, name)
          attribute.writeInt64(3, value)
          attribute.writeInt32(20, 2)
      case (name, other) =>
        throw IllegalArgumentException(s"attribute $name: expected a whole number, got $other")

  private def written(name: String, tensor: Tensor, out: CodedOutputStream): Unit =
    val raw = ByteBuffer.allocate(4 * tensor.values.size).order(ByteOrder.LITTLE_ENDIAN)
    tensor.values.foreach(value => raw.putFloat(value.toFloat))
    tensor.shape.foreach(length => out.writeInt64(1, length))
    out.writeInt32(2, Float32)
    out.writeString(8, name)
    out.writeBytes(9, ByteString.copyFrom(raw.flip()))

  private def written(port: Port, out: CodedOutputStream): Unit =
    out.writeString(1, port.name)
    nested(out, 2)(nested(_, 1): tensor =>
      tensor.writeInt32(1, port.element)
      nested(tensor, 2): shape =>
        for length <- port.shape.toVector.flatten do
          nested(shape, 1)(one => length.fold(one.writeString(2, "batch"))(one.writeInt64(1, _))))

  private def nested(out: CodedOutputStream, field: Int)(write: CodedOutputStream => Unit): Unit =
    out.writeByteArray(field, message(write))

  private def message(write: CodedOutputStream => Unit): Array[Byte] =
    val bytes = ByteArrayOutputStream()
    val out   = CodedOutputStream.newInstance(bytes)
    write(out)
    out.flush()
    bytes.toByteArray
