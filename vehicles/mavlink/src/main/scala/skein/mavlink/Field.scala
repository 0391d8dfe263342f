package skein.mavlink

import java.nio.ByteBuffer
import java.nio.charset.StandardCharsets.UTF_8
import scala.compiletime.ops.int.S

/** The wire layout of one field of a message, little-endian.
  *
  * @param typeName name of the type in the published definitions
  * @param size size of one element, bytes
  * @param count number of elements; 0 if it is not an array
  * @param isExtension whether it is a later addition: such fields follow all others and are not part of the
  *   message's [[Definition.crcExtra]]
  */
final class Field[A] private (
    val typeName: String,
    val size: Int,
    val count: Int,
    val isExtension: Boolean,
    private[mavlink] val read: ByteBuffer => A,
    private[mavlink] val write: (ByteBuffer, A) => Unit
):
  def length: Int = size * count.max(1)

  def extension: Field[A] = new Field(typeName, size, count, true, read, write)

  def times[N <: Int & Singleton](count: N): Field.Repeated[N, A] =
    Tuple.fromArray(Array.fill(count)(this)).asInstanceOf[Field.Repeated[N, A]]

object Field:
  type Repeated[N <: Int, A] <: Tuple = N match
    case 0    => EmptyTuple
    case S[n] => Field[A] *: Repeated[n, A]

  val u8: Field[Int]    = one("uint8_t", 1)(_.get() & 0xff, (to, value) => to.put(value.toByte))
  val i8: Field[Int]    = one("int8_t", 1)(_.get().toInt, (to, value) => to.put(value.toByte))
  val u16: Field[Int]   = one("uint16_t", 2)(_.getShort() & 0xffff, (to, value) => to.putShort(value.toShort))
  val i16: Field[Int]   = one("int16_t", 2)(_.getShort().toInt, (to, value) => to.putShort(value.toShort))
  val u32: Field[Long]  = one("uint32_t", 4)(_.getInt() & 0xffffffffL, (to, value) => to.putInt(value.toInt))
  val i32: Field[Int]   = one("int32_t", 4)(_.getInt(), _.putInt(_))
  val u64: Field[Long]  = one("uint64_t", 8)(_.getLong(), _.putLong(_))
  val i64: Field[Long]  = one("int64_t", 8)(_.getLong(), _.putLong(_))
  val f32: Field[Float] = one("float", 4)(_.getFloat(), _.putFloat(_))

  def u8s(count: Int): Field[Vector[Int]]    = many(u8, count, 0)
  def u16s(count: Int): Field[Vector[Int]]   = many(u16, count, 0)
  def f32s(count: Int): Field[Vector[Float]] = many(f32, count, 0f)

  /** Text of at most `count` bytes, terminated by a zero if shorter. Longer text is cut. */
  def chars(count: Int): Field[String] = new Field(
    "char",
    1,
    count,
    false,
    from =>
      val bytes = new Array[Byte](count)
      from.get(bytes)
      String(bytes.takeWhile(_ != 0), UTF_8)
    ,
    (to, text) => to.put(text.getBytes(UTF_8).padTo(count, 0.toByte).take(count)): Unit
  )

  private def one[A](typeName: String, size: Int)(
      read: ByteBuffer => A,
      write: (ByteBuffer, A) => ByteBuffer
  ): Field[A] = new Field(typeName, size, 0, false, read, (to, value) => write(to, value): Unit)

  /** An array of `count` elements; missing elements become zero, surplus ones are dropped. */
  private def many[A](element: Field[A], count: Int, zero: A): Field[Vector[A]] = new Field(
    element.typeName,
    element.size,
    count,
    false,
    from => Vector.fill(count)(element.read(from)),
    (to, values) => values.padTo(count, zero).take(count).foreach(element.write(to, _))
  )
