package skein.mavlink

import java.nio.{ByteBuffer, ByteOrder}
import java.nio.charset.StandardCharsets.US_ASCII
import scala.annotation.publicInBinary
import scala.compiletime.{constValue, constValueTuple}
import scala.deriving.Mirror
import scala.reflect.ClassTag

/** One kind of message: its number, its name and the layout of its fields in a payload. On the wire the
  * fields are ordered by the size of their elements, the greatest first, and extensions follow as published.
  */
final class Definition[A <: Message] @publicInBinary private[mavlink] (
    val id: Int,
    label: String,
    mirror: Mirror.ProductOf[A],
    fieldLabels: Tuple,
    fieldCodecs: Tuple,
    private[mavlink] val of: Class[?]
):
  private val labels = fieldLabels.productIterator.map(_.toString).toVector
  private val fields = fieldCodecs.productIterator.map(_.asInstanceOf[Field[?]]).toVector

  /** The published name, such as `LOCAL_POSITION_NED`. */
  val name: String = Definition.snake(label).toUpperCase(java.util.Locale.ROOT)

  private val (base, extensions) = fields.indices.toVector.partition(!fields(_).isExtension)
  private val ordered            = base.sortBy(-fields(_).size)

  val length: Int = fields.map(_.length).sum

  /** A hash of the definition that enters every checksum, so that peers with different definitions reject
    * each other's frames.
    */
  val crcExtra: Int =
    val described = ordered.foldLeft(Checksum.Start.add(s"$name ".getBytes(US_ASCII))): (sum, index) =>
      val field = fields(index)
      val named = sum.add(s"${field.typeName} ${Definition.snake(labels(index))} ".getBytes(US_ASCII))
      if field.count == 0 then named else named.add(field.count)
    (described.value & 0xff) ^ (described.value >> 8)

  /** The payload without trailing zeros; at least one byte. */
  def encode(message: A): Array[Byte] =
    val bytes = ByteBuffer.allocate(length).order(ByteOrder.LITTLE_ENDIAN)
    for index <- ordered ++ extensions do write(fields(index), bytes, message.productElement(index))
    bytes.array.take(bytes.array.lastIndexWhere(_ != 0).max(0) + 1)

  /** Decodes any bytes: missing ones count as zero, surplus ones belong to unknown extensions. */
  def decode(payload: Array[Byte]): A =
    val bytes  = ByteBuffer.wrap(payload.padTo(length, 0.toByte)).order(ByteOrder.LITTLE_ENDIAN)
    val values = new Array[Any](fields.size)
    for index <- ordered ++ extensions do values(index) = fields(index).read(bytes)
    mirror.fromProduct(Tuple.fromArray(values))

  private def write[B](field: Field[B], to: ByteBuffer, value: Any): Unit =
    field.write(to, value.asInstanceOf[B])

object Definition:
  inline def define[A <: Message](id: Int)(using
      mirror: Mirror.ProductOf[A],
      tag: ClassTag[A]
  )(
      fields: Tuple.Map[mirror.MirroredElemTypes, Field]
  ): Definition[A] = Definition(
    id,
    constValue[mirror.MirroredLabel],
    mirror,
    constValueTuple[mirror.MirroredElemLabels],
    fields,
    tag.runtimeClass
  )

  private def snake(name: String): String =
    name.zipWithIndex.map((c, at) =>
      if c.isUpper then (if at == 0 then "" else "_") + c.toLower else s"$c"
    ).mkString
