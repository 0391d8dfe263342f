package skein.mcap

import java.nio.charset.StandardCharsets.UTF_8
import java.nio.{ByteBuffer, ByteOrder}
import java.util.Arrays

/** Immutable bytes: a view of a part of an array. Equality compares contents. */
final class Bytes private (private[mcap] val array: Array[Byte], private[mcap] val from: Int, val size: Int):

  def apply(index: Int): Byte =
    require(index >= 0 && index < size, s"byte $index of $size")
    array(from + index)

  def slice(start: Int, until: Int): Bytes =
    require(0 <= start && start <= until && until <= size, s"bytes $start until $until of $size")
    new Bytes(array, from + start, until - start)

  def toArray: Array[Byte] = Arrays.copyOfRange(array, from, from + size)

  /** A read-only buffer of the bytes in MCAP's byte order, little-endian. */
  def buffer: ByteBuffer =
    ByteBuffer.wrap(array, from, size).slice.asReadOnlyBuffer.order(ByteOrder.LITTLE_ENDIAN)

  def utf8: String = String(array, from, size, UTF_8)

  override def equals(other: Any): Boolean = other match
    case that: Bytes =>
      Arrays.equals(array, from, from + size, that.array, that.from, that.from + that.size)
    case _ => false

  override def hashCode: Int      = buffer.hashCode
  override def toString(): String = s"$size bytes"

object Bytes:
  val empty: Bytes = new Bytes(Array.emptyByteArray, 0, 0)

  /** A view of an array, which must not change any more. */
  def of(array: Array[Byte]): Bytes = new Bytes(array, 0, array.length)

  def of(array: Array[Byte], from: Int, until: Int): Bytes =
    require(0 <= from && from <= until && until <= array.length, s"$from until $until of ${array.length}")
    new Bytes(array, from, until - from)

  def utf8(text: String): Bytes = of(text.getBytes(UTF_8))
