package skein.rpc

import java.nio.ByteBuffer
import java.nio.charset.StandardCharsets.UTF_8
import org.apache.pekko.util.ByteString
import upack.{Arr, Binary, Ext, False, Float32, Float64, Int32, Int64, Msg, Null, Obj, Str, True, UInt64}

/** Encodes messages one after another, to be sent in one write. Strings are `str`, integers take their
  * shortest form. Binary values of 32 KiB and more are sent from their own array, without a copy: it must not
  * change afterwards. One thread at a time.
  */
final class MessageWriter:
  import MessageWriter.*

  private var buffer   = new Array[Byte](InitialCapacity)
  private var used     = 0
  private var finished = ByteString.empty

  def length: Int = finished.length + used

  def request(id: Long, method: String, params: Seq[Msg]): Unit =
    byte(0x94)
    byte(0)
    integer(id)
    string(method)
    array(params.length)
    params.foreach(value)

  /** A reply: `Left` fills the error slot, `Right` the result. */
  def reply(id: Long, outcome: Either[String, Msg | Encoded]): Unit =
    byte(0x94)
    byte(1)
    integer(id)
    outcome match
      case Left(error) =>
        string(error)
        byte(0xc0)
      case Right(result: Msg) =>
        byte(0xc0)
        value(result)
      case Right(Encoded(result)) =>
        byte(0xc0)
        inPlace(result)

  /** Returns everything encoded since the last call. */
  def take(): ByteString =
    flush()
    val taken = finished
    finished = ByteString.empty
    taken

  /** Discards all bytes not yet taken except the first `length`. */
  def backTo(length: Int): Unit =
    flush()
    finished = finished.take(length).compact

  private def flush(): Unit =
    if used > 0 then
      finished = finished ++ ByteString.fromArrayUnsafe(java.util.Arrays.copyOf(buffer, used))
      used = 0
      if buffer.length > KeptCapacity then buffer = new Array[Byte](InitialCapacity)

  /** Writes the header of a map; its keys and values must follow. */
  def map(size: Int): Unit = sized(size, 0x80, 16, -1, 0xde, 0xdf)

  /** Writes the header of an array; its elements must follow. */
  def array(length: Int): Unit = sized(length, 0x90, 16, -1, 0xdc, 0xdd)

  /** Writes an array of 32-bit floats, five bytes each. */
  def floats(values: Array[Float]): Unit =
    array(values.length)
    numbers(values.length, 5): (encoded, i) =>
      encoded.put(0xca.toByte).putFloat(values(i)): Unit

  def integers(values: Array[Int]): Unit =
    array(values.length)
    numbers(values.length, 5): (encoded, i) =>
      encoded.put(0xd2.toByte).putInt(values(i)): Unit

  private inline def numbers(length: Int, bytesEach: Int)(inline put: (ByteBuffer, Int) => Unit): Unit =
    val encoded = ByteBuffer.allocate(Math.multiplyExact(length, bytesEach))
    var i       = 0
    while i < length do
      put(encoded, i)
      i += 1
    inPlace(ByteString.fromArrayUnsafe(encoded.array))

  private def inPlace(encoded: ByteString): Unit =
    flush()
    finished = finished ++ encoded

  def value(msg: Msg): Unit = msg match
    case Null        => byte(0xc0)
    case False       => byte(0xc2)
    case True        => byte(0xc3)
    case Int32(v)    => integer(v)
    case Int64(v)    => integer(v)
    case UInt64(v)   => if v >= 0 then integer(v) else number(0xcf, v, 8)
    case Float32(v)  => number(0xca, java.lang.Float.floatToIntBits(v), 4)
    case Float64(v)  => number(0xcb, java.lang.Double.doubleToLongBits(v), 8)
    case Str(v)      => string(v)
    case Binary(v)   => binary(v)
    case Ext(tag, v) => extended(tag, v)
    case Arr(items)  =>
      array(items.length)
      var i = 0
      while i < items.length do
        value(items(i))
        i += 1
    case Obj(entries) =>
      map(entries.size)
      for (key, item) <- entries do
        value(key)
        value(item)

  /** Writes a map with names as keys.
    *
    * @param large writes the values of some keys in place of those in the map
    */
  def structure(fields: Msg)(large: PartialFunction[String, Unit]): Unit =
    map(fields.obj.size)
    for (name, item) <- fields.obj do
      value(name)
      large.applyOrElse(name.str, _ => value(item))

  private def integer(v: Long): Unit =
    if v >= -32 && v <= 127 then byte(v.toInt)
    else if v >= 0 then
      if v <= 0xff then number(0xcc, v, 1)
      else if v <= 0xffff then number(0xcd, v, 2)
      else if v <= 0xffffffffL then number(0xce, v, 4)
      else number(0xcf, v, 8)
    else if v >= Byte.MinValue then number(0xd0, v, 1)
    else if v >= Short.MinValue then number(0xd1, v, 2)
    else if v >= Int.MinValue then number(0xd2, v, 4)
    else number(0xd3, v, 8)

  private def string(v: String): Unit =
    val encoded = v.getBytes(UTF_8)
    sized(encoded.length, 0xa0, 32, 0xd9, 0xda, 0xdb)
    bytes(encoded)

  private def binary(v: Array[Byte]): Unit =
    sized(v.length, 0, 0, 0xc4, 0xc5, 0xc6)
    if v.length < SentInPlace then bytes(v)
    else inPlace(ByteString.fromArrayUnsafe(v))

  private def extended(tag: Byte, v: Array[Byte]): Unit =
    v.length match
      case 1  => byte(0xd4)
      case 2  => byte(0xd5)
      case 4  => byte(0xd6)
      case 8  => byte(0xd7)
      case 16 => byte(0xd8)
      case n  => sized(n, 0, 0, 0xc7, 0xc8, 0xc9)
    byte(tag)
    bytes(v)

  /** A header with a length: inside the marker below `inMarker`, else in one, two or four bytes; -1 if
    * MessagePack has no such form.
    */
  private def sized(length: Int, fix: Int, inMarker: Int, one: Int, two: Int, four: Int): Unit =
    if length < inMarker then byte(fix | length)
    else if one >= 0 && length <= 0xff then number(one, length, 1)
    else if length <= 0xffff then number(two, length, 2)
    else number(four, length, 4)

  private def number(marker: Int, v: Long, size: Int): Unit =
    byte(marker)
    ensure(size)
    var shift = 8 * (size - 1)
    while shift >= 0 do
      buffer(used) = (v >> shift).toByte
      used += 1
      shift -= 8

  private def byte(v: Int): Unit =
    ensure(1)
    buffer(used) = v.toByte
    used += 1

  private def bytes(v: Array[Byte]): Unit =
    ensure(v.length)
    System.arraycopy(v, 0, buffer, used, v.length)
    used += v.length

  private def ensure(more: Int): Unit =
    if used + more > buffer.length then
      buffer = java.util.Arrays.copyOf(buffer, math.max(used + more, 2 * buffer.length))

object MessageWriter:
  private val InitialCapacity = 4096
  private val KeptCapacity    = 256 << 10
  private val SentInPlace     = 32 << 10

  /** Encodes what `write` writes, which must be exactly one value. */
  def encode(write: MessageWriter => Unit): Encoded =
    val writer = MessageWriter()
    write(writer)
    Encoded(writer.take())
