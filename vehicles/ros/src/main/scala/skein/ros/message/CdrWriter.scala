package skein.ros.message

import java.nio.charset.StandardCharsets.UTF_8
import java.nio.{ByteBuffer, ByteOrder}
import scala.collection.immutable.ArraySeq

/** Writes CDR (XCDR1, plain, little-endian) into a buffer that grows. */
final class CdrWriter:
  private var buffer = ByteBuffer.allocate(512).order(ByteOrder.LITTLE_ENDIAN)
  buffer.put(Array[Byte](0, 1, 0, 0)): Unit

  private def reserve(bytes: Int, aligned: Int): ByteBuffer =
    // The buffer's header has four bytes, to which eight-byte numbers are not aligned.
    val body  = buffer.position - CdrReader.HeaderBytes
    val start = ((body + aligned - 1) & -aligned) + CdrReader.HeaderBytes
    val end   = start.toLong + bytes
    if end > buffer.capacity then
      require(end <= CdrWriter.MostBytes, s"a message has $end bytes, at most ${CdrWriter.MostBytes} go")
      val larger =
        ByteBuffer.allocate((2 * end).min(CdrWriter.MostBytes).toInt).order(ByteOrder.LITTLE_ENDIAN)
      buffer = larger.put(buffer.flip())
    while buffer.position < start do buffer.put(0.toByte): Unit
    buffer

  def byte(value: Byte): Unit       = reserve(1, 1).put(value): Unit
  def boolean(value: Boolean): Unit = byte(if value then 1 else 0)
  def short(value: Short): Unit     = reserve(2, 2).putShort(value): Unit
  def int(value: Int): Unit         = reserve(4, 4).putInt(value): Unit
  def float(value: Float): Unit     = reserve(4, 4).putFloat(value): Unit
  def double(value: Double): Unit   = reserve(8, 8).putDouble(value): Unit

  def text(value: String): Unit =
    val chars = value.getBytes(UTF_8)
    int(chars.length + 1)
    reserve(chars.length + 1, 1).put(chars).put(0.toByte): Unit

  def bytes(values: ArraySeq[Byte]): Unit =
    val plain = values match
      case packed: ArraySeq.ofByte => packed.unsafeArray
      case other                   => other.toArray
    reserve(values.size, 1).put(plain): Unit

  def floats(values: ArraySeq[Float]): Unit   = values.foreach(float)
  def doubles(values: ArraySeq[Double]): Unit = values.foreach(double)

  /** The message so far, with the four bytes that state its encoding. */
  def result: Array[Byte] = buffer.array.take(buffer.position)

private object CdrWriter:
  /** Maximum size of a message in bytes, half of what an array can hold: an image of 16 K by 16 K pixels. */
  val MostBytes: Long = 1L << 30
