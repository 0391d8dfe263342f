package skein.ros.message

import java.nio.charset.StandardCharsets.UTF_8
import java.nio.{ByteBuffer, ByteOrder}
import scala.collection.immutable.ArraySeq

/** Reads CDR (XCDR1, plain) in either byte order. Positions count from the first byte after the four that
  * state the encoding, and numbers are aligned to their own size. A count never exceeds the bytes that are
  * left, so that no message makes it allocate more than a few times its own length.
  */
final class CdrReader private (body: ByteBuffer):

  private def aligned(bytes: Int, to: Int): ByteBuffer =
    val at = (body.position + to - 1) & -to
    if body.limit - at < bytes then
      throw CdrError(s"expected $bytes more bytes at byte $at, the message ends at ${body.limit}")
    body.position(at)

  def byte(): Byte     = aligned(1, 1).get()
  def short(): Short   = aligned(2, 2).getShort()
  def int(): Int       = aligned(4, 4).getInt()
  def float(): Float   = aligned(4, 4).getFloat()
  def double(): Double = aligned(8, 8).getDouble()

  def boolean(): Boolean = byte() match
    case 0    => false
    case 1    => true
    case came => throw CdrError(s"expected 0 or 1 at byte ${body.position - 1}, got $came")

  /** A number of elements, each of which takes at least `leastBytes`. */
  def count(leastBytes: Int): Int =
    val came = int()
    val most = body.remaining / leastBytes
    if came < 0 || came > most then
      throw CdrError(
        s"expected a count of 0 to $most at byte ${body.position - 4}, got ${came & 0xffffffffL}"
      )
    came

  /** A text, which ends with a zero byte. An empty text may lack it, as some vendors send it. */
  def text(): String =
    val length = count(1)
    if length == 0 then ""
    else
      val chars = new Array[Byte](length)
      val _     = body.get(chars)
      if chars(length - 1) != 0 then
        throw CdrError(s"expected a text that ends with 0 at byte ${body.position - 1}")
      String(chars, 0, length - 1, UTF_8)

  def bytes(count: Int): ArraySeq[Byte] =
    val read = new Array[Byte](count)
    val _    = aligned(count, 1).get(read)
    ArraySeq.unsafeWrapArray(read)

  def floats(count: Int): ArraySeq[Float] =
    if count > 0 then aligned(4 * count, 4): Unit
    ArraySeq.unsafeWrapArray(Array.fill(count)(body.getFloat()))

  def doubles(count: Int): ArraySeq[Double] =
    if count > 0 then aligned(8 * count, 8): Unit
    ArraySeq.unsafeWrapArray(Array.fill(count)(body.getDouble()))

  private[message] def rest: Int = body.remaining

private[message] object CdrReader:
  /** Bytes before the message that state its encoding. */
  val HeaderBytes = 4

  /** @throws CdrError if the bytes begin with another encoding */
  def of(bytes: Array[Byte]): CdrReader =
    if bytes.length < HeaderBytes then
      throw CdrError(s"expected at least $HeaderBytes bytes, got ${bytes.length}")
    val order = (bytes(0), bytes(1)) match
      case (0, 0) => ByteOrder.BIG_ENDIAN
      case (0, 1) => ByteOrder.LITTLE_ENDIAN
      case (a, b) =>
        val came = java.util.HexFormat.of.formatHex(Array(a, b))
        throw CdrError(s"expected plain CDR, 0x0000 or 0x0001, got 0x$came")
    CdrReader(ByteBuffer.wrap(bytes, HeaderBytes, bytes.length - HeaderBytes).slice().order(order))
