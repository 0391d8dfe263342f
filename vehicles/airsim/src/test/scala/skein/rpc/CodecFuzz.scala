package skein.rpc

import org.msgpack.core.{
  MessageFormatException,
  MessageInsufficientBufferException,
  MessageNeverUsedFormatException
}
import org.msgpack.core.{MessagePack, MessagePackException, MessageSizeException, MessageUnpacker}
import org.msgpack.value.Value
import scala.jdk.CollectionConverters.*
import scala.util.Random
import upack.*

/** Mutated byte sequences for the codec, checked against an oracle: equal values at equal positions, an equal
  * end, and no exception.
  */
object CodecFuzz:

  /** Counts of the sequences by their results; `values` are complete messages, all of them as the oracle
    * reads them.
    */
  final case class Figures(
      sequences: Int,
      values: Long,
      whole: Int,
      cut: Int,
      refused: Int,
      malformedMessages: Long
  )

  def run(sequences: Int, seed: Long): Figures =
    var values, malformed   = 0L
    var whole, cut, refused = 0
    for i <- 0 until sequences do
      val random  = Random(seed + i)
      val bytes   = Mutation.of(random, Mutation.request)
      val framer  = Framer(limits)
      val found   = Wire.framed(framer, Wire.segments(bytes, random))
      val frames  = found.collect { case Framed.Complete(frame) => frame }
      val refusal = found.collectFirst { case Framed.Malformed(reason) => reason }
      judge(bytes, frames, refusal, framer.midway, s"seed ${seed + i}")
      for frame <- frames do
        RpcMessage.fromServer(frame)
        if RpcMessage.fromClient(frame).isInstanceOf[RpcMessage.Malformed] then malformed += 1
      values += frames.length
      if refusal.nonEmpty then refused += 1
      else if framer.midway then cut += 1
      else whole += 1
    Figures(sequences, values, whole, cut, refused, malformed)

  private val limits = FrameLimits(frameBytes = 1 << 20, depth = 32, elements = 1 << 16)

  private def judge(
      bytes: Array[Byte],
      frames: Seq[Array[Byte]],
      refusal: Option[String],
      midway: Boolean,
      clue: String
  ): Unit =
    val oracle = MessagePack.newDefaultUnpacker(bytes)
    var start  = 0
    for frame <- frames do
      oracle.skipValue()
      val end = oracle.getTotalReadBytes.toInt
      check(
        java.util.Arrays.equals(frame, bytes.slice(start, end)),
        s"a value of other bytes at $start, $clue"
      )
      start = end
      for value <- read(frame) do
        check(same(upack.read(frame), value), s"read ${upack.read(frame)}, expected $value, $clue")
    end(oracle) match
      case End.Whole => check(refusal.isEmpty && !midway, s"expected the end, $clue")
      case End.Cut => check(refusal.forall(isLimit) && (midway || refusal.nonEmpty), s"expected a cut, $clue")
      case End.NeverUsed => check(refusal.nonEmpty, s"expected a refusal, $clue")
      case End.TooLong   => check(refusal.exists(isLimit), s"expected a limit, $clue")
      case End.Value     => check(refusal.exists(isLimit), s"a value was missed, $clue")

  private enum End:
    case Whole, Cut, NeverUsed, TooLong, Value

  private def end(oracle: MessageUnpacker): End =
    try
      if !oracle.hasNext then End.Whole
      else
        oracle.skipValue()
        End.Value
    catch
      case _: MessageInsufficientBufferException => End.Cut
      case _: MessageNeverUsedFormatException    => End.NeverUsed
      case _: MessageSizeException               => End.TooLong

  private def isLimit(reason: String): Boolean =
    Seq("nested", "a message of", "a map of").exists(reason.startsWith)

  /** None if the oracle is stricter about an extension of type -1 (a time stamp) than the format. */
  private def read(frame: Array[Byte]): Option[Value] =
    try Some(Wire.unpack(frame))
    catch case _: MessageFormatException | _: MessagePackException => None

  private def same(ours: Msg, theirs: Value): Boolean = ours match
    case Str(text)  => theirs.isStringValue && text == utf8(theirs.asRawValue.asByteArray)
    case Arr(items) =>
      theirs.isArrayValue && items.length == theirs.asArrayValue.size &&
      items.indices.forall(i => same(items(i), theirs.asArrayValue.get(i)))
    case Obj(entries) =>
      // A duplicate key keeps its last value in ours; the oracle's list of pairs has both.
      theirs.isMapValue && entries.forall: (key, item) =>
        theirs.asMapValue.entrySet.asScala.exists(e => same(key, e.getKey) && same(item, e.getValue))
    case Ext(-1, _) =>
      theirs.isTimestampValue || Wire.toValue(ours) == theirs // a time, normalised by the oracle
    case Float32(v) => theirs.isFloatValue && sameBits(v, theirs.asFloatValue.toDouble)
    case Float64(v) => theirs.isFloatValue && sameBits(v, theirs.asFloatValue.toDouble)
    case other      => Wire.toValue(other) == theirs

  private def sameBits(a: Double, b: Double): Boolean = a == b || (a.isNaN && b.isNaN)

  private def utf8(raw: Array[Byte]): String = String(raw, java.nio.charset.StandardCharsets.UTF_8)

  private def check(holds: Boolean, clue: => String): Unit = if !holds then throw AssertionError(clue)
