package skein.rpc

import java.io.ByteArrayOutputStream
import org.apache.pekko.util.ByteString
import org.msgpack.core.MessagePack
import org.msgpack.value.{Value, ValueFactory}
import scala.jdk.CollectionConverters.*
import scala.util.Random
import upack.*

/** Random MessagePack values, and an independent implementation as an oracle. */
object Wire:

  /** The value as the oracle represents it; its equality is by number, not by the width of the encoding. */
  def toValue(msg: Msg): Value = msg match
    case Null        => ValueFactory.newNil()
    case False       => ValueFactory.newBoolean(false)
    case True        => ValueFactory.newBoolean(true)
    case Int32(v)    => ValueFactory.newInteger(v)
    case Int64(v)    => ValueFactory.newInteger(v)
    case UInt64(v)   => ValueFactory.newInteger(java.math.BigInteger(java.lang.Long.toUnsignedString(v)))
    case Float32(v)  => ValueFactory.newFloat(v)
    case Float64(v)  => ValueFactory.newFloat(v)
    case Str(v)      => ValueFactory.newString(v)
    case Binary(v)   => ValueFactory.newBinary(v)
    case Ext(tag, v) => ValueFactory.newExtension(tag, v)
    case Arr(items)  => ValueFactory.newArray(items.map(toValue).asJava)
    case Obj(pairs)  => ValueFactory.newMap(pairs.map((k, v) => toValue(k) -> toValue(v)).toMap.asJava)

  def notification(method: String, params: Msg*): Array[Byte] = pack(Arr(Int32(2), Str(method), Arr(params*)))

  def pack(msg: Msg): Array[Byte] =
    val out    = ByteArrayOutputStream()
    val packer = MessagePack.newDefaultPacker(out)
    packer.packValue(toValue(msg))
    packer.close()
    out.toByteArray

  /** Reads exactly one value with the oracle. */
  def unpack(bytes: Array[Byte]): Value =
    val unpacker = MessagePack.newDefaultUnpacker(bytes)
    val value    = unpacker.unpackValue()
    assert(!unpacker.hasNext, "bytes after the value")
    value

  /** A random value of at most `depth` levels; strings and binaries have at most about `longest` bytes, often
    * at the edge of an encoding.
    */
  def randomMsg(random: Random, depth: Int = 4, longest: Int = 71_000): Msg =
    def length = math.min(edgeLength(random), longest)
    def inner  = randomMsg(random, depth - 1, longest)
    random.nextInt(if depth > 0 then 15 else 12) match
      case 0  => Null
      case 1  => if random.nextBoolean() then True else False
      case 2  => Int32(random.nextInt() >> random.nextInt(32))
      case 3  => Int64(random.nextLong() >> random.nextInt(64))
      case 4  => UInt64(random.nextLong() >>> random.nextInt(64))
      case 5  => Float32(random.nextFloat())
      case 6  => Float64(random.nextDouble())
      case 7  => Str(random.alphanumeric.take(length).mkString)
      case 8  => Str(String.valueOf(Array.fill(random.nextInt(40))(('\u00a1' + random.nextInt(3000)).toChar)))
      case 9  => Binary(random.nextBytes(length))
      case 10 => Ext(random.nextInt(128).toByte, random.nextBytes(1 << random.nextInt(5)))
      case 11 => Ext(random.nextInt(128).toByte, random.nextBytes(length))
      case 12 => Arr(Seq.fill(random.nextInt(20))(inner)*)
      case 13 => Arr(Seq.fill(random.nextInt(4))(inner)*)
      case _  =>
        val pairs = Seq.fill(random.nextInt(18))(Str(random.nextString(3)) -> inner)
        Obj(upickle.core.LinkedHashMap[Msg, Msg](pairs))

  private def edgeLength(random: Random): Int = random.nextInt(12) match
    case 0 => 70_000 + random.nextInt(1000)
    case 1 => 250 + random.nextInt(12)
    case 2 => 28 + random.nextInt(8)
    case _ => random.nextInt(20)

  /** The bytes in random segments, from single bytes to a single segment. */
  def segments(bytes: Array[Byte], random: Random): Seq[ByteString] =
    val longest = 1 + random.nextInt(1 << random.nextInt(18))
    val pieces  = Seq.newBuilder[ByteString]
    var at      = 0
    while at < bytes.length do
      val size = math.min(1 + random.nextInt(longest), bytes.length - at)
      pieces += ByteString.fromArray(bytes, at, size)
      at += size
    pieces.result()

  /** Everything that the framer returns for the segments, up to and including a refusal. */
  def framed(framer: Framer, segments: Seq[ByteString]): Seq[Framed] =
    val all     = Seq.newBuilder[Framed]
    val pending = segments.iterator
    var broken  = false
    while !broken && pending.hasNext do
      framer.offer(pending.next())
      var more = true
      while more do
        framer.next() match
          case Framed.NeedsMore          => more = false
          case refusal: Framed.Malformed =>
            all += refusal
            more = false
            broken = true
          case complete => all += complete
    all.result()
