package skein.record

import java.io.ByteArrayOutputStream
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.{ByteBuffer, ByteOrder}
import skein.mcap.Bytes

/** A message of Protocol Buffers, written field by field (https://protobuf.dev/programming-guides/encoding): as much as the
  * large messages of viewers need, whose bytes would be a third more as JSON.
  */
private[record] final class Protobuf(expected: Int = 64):
  private val out = ByteArrayOutputStream(expected)

  def varint(field: Int, value: Long): Protobuf =
    tag(field, 0)
    raw(value)
    this

  def fixed32(field: Int, value: Int): Protobuf =
    tag(field, 5)
    out.write(Protobuf.ordered(4).putInt(value).array)
    this

  def double(field: Int, value: Double): Protobuf =
    tag(field, 1)
    out.write(Protobuf.ordered(8).putDouble(value).array)
    this

  def bytes(field: Int, value: Array[Byte]): Protobuf =
    tag(field, 2)
    raw(value.length)
    out.write(value)
    this

  def text(field: Int, value: String): Protobuf      = bytes(field, value.getBytes(UTF_8))
  def message(field: Int, value: Protobuf): Protobuf = bytes(field, value.result)

  def result: Array[Byte] = out.toByteArray

  private def tag(field: Int, wire: Int): Unit = raw((field << 3 | wire).toLong)

  private def raw(value: Long): Unit =
    var left = value
    while (left & ~0x7fL) != 0 do
      out.write((left.toInt & 0x7f) | 0x80)
      left >>>= 7
    out.write(left.toInt)

private[record] object Protobuf:
  private def ordered(size: Int) = ByteBuffer.allocate(size).order(ByteOrder.LITTLE_ENDIAN)

  /** The last field of this number that holds bytes.
    *
    * @return
    *   absent where there is none, or the message is damaged
    */
  def bytesOf(message: Bytes, field: Int): Option[Bytes] =
    var at    = 0
    var found = Option.empty[Bytes]
    var whole = true

    def varint(): Long =
      var value = 0L
      var shift = 0
      var more  = true
      while more && at < message.size && shift < 64 do
        val byte = message(at)
        value |= (byte & 0x7fL) << shift
        shift += 7
        at += 1
        more = byte < 0
      if more then whole = false
      value

    while whole && at < message.size do
      val tag  = varint()
      val size = (tag & 7).toInt match
        case 0 => varint(); 0L
        case 1 => 8L
        case 2 => varint()
        case 5 => 4L
        case _ => -1L
      if size < 0 || size > message.size - at then whole = false
      else
        if (tag & 7) == 2 && tag >>> 3 == field then found = Some(message.slice(at, at + size.toInt))
        at += size.toInt
    found.filter(_ => whole)
