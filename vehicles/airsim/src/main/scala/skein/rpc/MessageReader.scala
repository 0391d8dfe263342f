package skein.rpc

import java.lang.Double.longBitsToDouble
import java.lang.Float.intBitsToFloat
import java.nio.ByteBuffer
import java.nio.charset.StandardCharsets.UTF_8

/** A slice of an array that must not change. */
final class Bytes(array: Array[Byte], offset: Int, val length: Int):

  /** A read-only view of the bytes, without a copy. */
  def buffer: ByteBuffer = ByteBuffer.wrap(array, offset, length).slice().asReadOnlyBuffer()

  def apply(index: Int): Byte =
    java.util.Objects.checkIndex(index, length): Unit
    array(offset + index)

  def toArray: Array[Byte] = java.util.Arrays.copyOfRange(array, offset, offset + length)

object Bytes:
  val empty: Bytes = Bytes(Array.emptyByteArray, 0, 0)

/** An undecoded MessagePack value at the end of its message's bytes, to be read by a [[MessageReader]]. */
final class Received private[skein] (private[rpc] val bytes: Array[Byte], private[rpc] val from: Int):
  private[rpc] def toArray: Array[Byte] = java.util.Arrays.copyOfRange(bytes, from, bytes.length)

/** Reads one MessagePack value from front to back, directly into the caller's types: it builds no tree of
  * values and copies no binary. Numbers are read from any of MessagePack's encodings.
  */
final class MessageReader private (bytes: Array[Byte], private var at: Int, end: Int):
  import MessageReader.Unexpected

  /** Number of elements that follow; each has to be read or skipped. */
  def array(): Int = header() match
    case marker if (marker & 0xf0) == 0x90 => marker & 0x0f
    case 0xdc                              => size(2, least = 1)
    case 0xdd                              => size(4, least = 1)
    case other                             => unexpected("an array", other)

  /** Number of keys that follow, each with its value. */
  def map(): Int = header() match
    case marker if (marker & 0xf0) == 0x80 => marker & 0x0f
    case 0xde                              => size(2, least = 2)
    case 0xdf                              => size(4, least = 2)
    case other                             => unexpected("a map", other)

  /** Reads a map's fields in any order. `read` handles the fields that it is defined for; others are skipped.
    */
  def fields(read: PartialFunction[String, Unit]): Unit =
    for _ <- 0 until map() do
      val key = string()
      try read.applyOrElse(key, (_: String) => skip())
      catch case Unexpected(what) => throw Unexpected(s"$key: $what")

  def string(): String =
    val text = binary()
    String(bytes, at - text.length, text.length, UTF_8)

  /** Reads binary, or a string's bytes: AirSim's sender uses either. */
  def binary(): Bytes =
    val length = header() match
      case marker if (marker & 0xe0) == 0xa0 => marker & 0x1f
      case 0xc4 | 0xd9                       => size(1, least = 1)
      case 0xc5 | 0xda                       => size(2, least = 1)
      case 0xc6 | 0xdb                       => size(4, least = 1)
      case other                             => unexpected("binary or a string", other)
    need(length)
    at += length
    Bytes(bytes, at - length, length)

  def long(): Long =
    val marker = header()
    if marker < 0x80 || marker >= 0xe0 then marker.toByte.toLong
    else
      marker match
        case 0xcc | 0xd0 => if marker == 0xcc then take(1) else take(1).toByte.toLong
        case 0xcd | 0xd1 => if marker == 0xcd then take(2) else take(2).toShort.toLong
        case 0xce | 0xd2 => if marker == 0xce then take(4) else take(4).toInt.toLong
        case 0xcf | 0xd3 => take(8)
        case other       => unexpected("an integer", other)

  def int(): Int =
    val value = long()
    if value.isValidInt then value.toInt else throw Unexpected(s"expected a 32-bit integer, got $value")

  def double(): Double = peek() match
    case 0xca =>
      at += 1
      intBitsToFloat(take(4).toInt).toDouble
    case 0xcb =>
      at += 1
      longBitsToDouble(take(8))
    case _ => long().toDouble

  /** Reads an array of numbers; 32-bit floats, as AirSim sends them, at memory speed. */
  def floats(): Array[Float] =
    val numbers = new Array[Float](array())
    var i       = 0
    while i < numbers.length do
      if end - at >= 5 && bytes(at) == 0xca.toByte then
        numbers(i) = MessageReader.FloatAt.get(bytes, at + 1): Float
        at += 5
      else numbers(i) = double().toFloat
      i += 1
    numbers

  def ints(): Array[Int] =
    val numbers = new Array[Int](array())
    var i       = 0
    while i < numbers.length do
      numbers(i) = int()
      i += 1
    numbers

  def skip(): Unit =
    var left = 1L
    while left > 0 do
      val marker = header()
      if marker == Framer.NeverUsed then unexpected("a value", marker)
      val size = take(Framer.lengthBytes(marker))
      pass(Framer.payloadBytes(marker, size))
      left += Framer.childCount(marker, size) - 1

  /** The next value and all that follows, without a copy. */
  private[rpc] def rest: Received = Received(bytes, at)

  private[rpc] def isArray: Boolean =
    val marker = peek()
    (marker & 0xf0) == 0x90 || marker == 0xdc || marker == 0xdd

  /** Returns one value's encoded bytes and skips it. */
  private[rpc] def raw(): Array[Byte] =
    val start = at
    skip()
    java.util.Arrays.copyOfRange(bytes, start, at)

  private def peek(): Int =
    need(1)
    bytes(at) & 0xff

  private def header(): Int =
    val marker = peek()
    at += 1
    marker

  private def take(count: Int): Long =
    need(count)
    var value = 0L
    for i <- 0 until count do value = value << 8 | (bytes(at + i) & 0xff)
    at += count
    value

  private def pass(count: Long): Unit =
    need(count)
    at += count.toInt

  /** Reads a length, refusing one whose elements, of at least `least` bytes each, cannot fit the bytes left:
    * so nothing is allocated for them.
    */
  private def size(bytesOfSize: Int, least: Int): Int =
    val length = take(bytesOfSize)
    if length * least > end - at then
      throw Unexpected(s"expected $length more values or bytes, got ${end - at} bytes")
    length.toInt

  private def need(count: Long): Unit =
    if end - at < count then throw Unexpected(s"expected $count more bytes, got ${end - at}")

  private def unexpected(what: String, marker: Int): Nothing =
    throw Unexpected(
      s"expected $what, got a value that begins with 0x${Integer.toHexString(marker | 0x100).drop(1)}"
    )

object MessageReader:
  private val FloatAt =
    java.lang.invoke.MethodHandles.byteArrayViewVarHandle(
      classOf[Array[Float]],
      java.nio.ByteOrder.BIG_ENDIAN
    )

  /** The value received differs from what `read` expects. */
  private[rpc] final case class Unexpected(what: String) extends RuntimeException(what, null, false, false)

  /** Applies `read` to one value; Left says what was expected and what was received. Binary in the result
    * refers to these bytes.
    */
  def read[A](received: Received)(read: MessageReader => A): Either[String, A] =
    attempt(read(new MessageReader(received.bytes, received.from, received.bytes.length)))

  private[rpc] def of(bytes: Array[Byte]): MessageReader = new MessageReader(bytes, 0, bytes.length)

  private[rpc] def attempt[A](read: => A): Either[String, A] =
    try Right(read)
    catch case Unexpected(what) => Left(what)
