package skein.mcap

import java.nio.charset.StandardCharsets.UTF_8
import java.nio.{ByteBuffer, ByteOrder}
import java.util.Arrays

/** A growing buffer for encoding, little-endian; reused after taking its bytes. */
private[mcap] final class ByteBuilder(initial: Int):
  private var bytes = new Array[Byte](initial.max(64))
  private var view  = ByteBuffer.wrap(bytes).order(ByteOrder.LITTLE_ENDIAN)
  private var used  = 0

  def array: Array[Byte] = bytes
  def size: Int          = used
  def clear(): Unit      = used = 0

  /** Reserves `count` bytes and gives their first index. */
  private def room(count: Int): Int =
    val at = used
    if bytes.length - at < count then grow(at.toLong + count)
    used = at + count
    at

  private def grow(needed: Long): Unit =
    require(needed <= ByteBuilder.Largest, s"$needed bytes do not fit into one array")
    bytes = Arrays.copyOf(bytes, needed.max((bytes.length * 2L).min(ByteBuilder.Largest)).toInt)
    view = ByteBuffer.wrap(bytes).order(ByteOrder.LITTLE_ENDIAN)

  def u8(value: Int): Unit =
    val at = room(1)
    bytes(at) = value.toByte

  def u16(value: Int): Unit =
    val at = room(2)
    view.putShort(at, value.toShort): Unit

  def u32(value: Int): Unit =
    val at = room(4)
    view.putInt(at, value): Unit

  def u64(value: Long): Unit =
    val at = room(8)
    view.putLong(at, value): Unit

  def raw(source: Array[Byte], from: Int, until: Int): Unit =
    val at = room(until - from)
    System.arraycopy(source, from, bytes, at, until - from)

  def raw(source: Bytes): Unit = raw(source.array, source.from, source.from + source.size)

  def string(text: String): Unit =
    val encoded = text.getBytes(UTF_8)
    u32(encoded.length)
    raw(encoded, 0, encoded.length)

  /** Writes the length of `body`'s output in bytes, as a 4-byte integer, and then the output. */
  inline def counted(inline body: Unit): Unit =
    val at = size
    u32(0)
    body
    patchU32(at, size - at - 4)

  /** Writes a record; `body` writes its content. */
  inline def record(opcode: Int)(inline body: Unit): Unit =
    val at = size
    u8(opcode)
    u64(0)
    body
    patchU64(at + 1, size - at - 9)

  def patchU32(at: Int, value: Int): Unit  = view.putInt(at, value): Unit
  def patchU64(at: Int, value: Long): Unit = view.putLong(at, value): Unit

private[mcap] object ByteBuilder:
  /** The largest array; beyond it, virtual machines differ in what they allocate. */
  private val Largest = Int.MaxValue - 8L
