package skein.mcap

import java.nio.{ByteBuffer, ByteOrder}
import java.util.Arrays

/** One block of LZ4 (https://github.com/lz4/lz4/blob/dev/doc/lz4_Block_format.md). */
private[mcap] object Lz4Block:
  private val MinMatch = 4

  /** A match neither starts in the last 12 bytes nor reaches into the last 5. */
  private val LastMatch    = 12
  private val LastLiterals = 5
  private val MaxDistance  = 65535
  private val HashBits     = 14

  /** Positions at which four bytes of a hash were last seen; each compressor has its own. */
  final class Memory:
    private[Lz4Block] val seen = new Array[Int](1 << HashBits)

  /** Gives where the block ends in `target`, which must have room for length + length / 255 + 16 bytes behind
    * `to`.
    */
  def compress(
      source: Array[Byte],
      from: Int,
      until: Int,
      target: Array[Byte],
      to: Int,
      memory: Memory
  ): Int =
    val view = ByteBuffer.wrap(source).order(ByteOrder.LITTLE_ENDIAN)
    val seen = memory.seen
    Arrays.fill(seen, from - MaxDistance - 1)
    val last   = until - LastMatch
    var at     = from
    var anchor = from
    var out    = to
    var misses = 0
    while at <= last do
      val word   = view.getInt(at)
      val slot   = (word * 0x9e3779b1) >>> (32 - HashBits)
      val before = seen(slot)
      seen(slot) = at
      if at - before <= MaxDistance && view.getInt(before) == word then
        var start = at
        var other = before
        while start > anchor && other > from && source(start - 1) == source(other - 1) do
          start -= 1
          other -= 1
        val end = matchEnd(source, view, at + MinMatch, before + MinMatch, until - LastLiterals)
        out = sequence(source, anchor, start, end - start, start - other, target, out)
        anchor = end
        at = end
        misses = 0
        if at <= last then seen((view.getInt(at - 2) * 0x9e3779b1) >>> (32 - HashBits)) = at - 2
      else
        // What does not compress is passed ever faster.
        misses += 1
        at += 1 + (misses >>> 6)
    literals(source, anchor, until, target, out)

  private def matchEnd(source: Array[Byte], view: ByteBuffer, first: Int, second: Int, limit: Int): Int =
    var at    = first
    var other = second
    while at + 8 <= limit && view.getLong(at) == view.getLong(other) do
      at += 8
      other += 8
    while at < limit && source(at) == source(other) do
      at += 1
      other += 1
    at

  private def sequence(
      source: Array[Byte],
      anchor: Int,
      until: Int,
      length: Int,
      distance: Int,
      target: Array[Byte],
      to: Int
  ): Int =
    var out  = literals(source, anchor, until, target, to)
    val more = length - MinMatch
    target(to) = (target(to) | more.min(15)).toByte
    target(out) = distance.toByte
    target(out + 1) = (distance >>> 8).toByte
    out += 2
    if more >= 15 then extended(more - 15, target, out) else out

  /** A token and its literals; a match of the shortest length is left to be added to the token. */
  private def literals(source: Array[Byte], from: Int, until: Int, target: Array[Byte], to: Int): Int =
    val length = until - from
    target(to) = (length.min(15) << 4).toByte
    val out = if length >= 15 then extended(length - 15, target, to + 1) else to + 1
    System.arraycopy(source, from, target, out, length)
    out + length

  private def extended(value: Int, target: Array[Byte], to: Int): Int =
    var left = value
    var out  = to
    while left >= 255 do
      target(out) = 255.toByte
      left -= 255
      out += 1
    target(out) = left.toByte
    out + 1

  /** Gives where the block ends in `target`, which it may look back into as far as `oldest`. Throws
    * `Damaged`; where the source is only a beginning (`cut`), gives what it holds instead.
    */
  def decompress(
      source: Array[Byte],
      from: Int,
      until: Int,
      target: Array[Byte],
      to: Int,
      limit: Int,
      oldest: Int,
      cut: Boolean
  ): Int =
    var at            = from
    var out           = to
    var open          = true
    def short(): Unit =
      if cut then open = false else throw Damaged("a block that ends within a sequence")
    while open do
      if at >= until then short()
      else
        val token  = source(at) & 0xff
        var length = token >>> 4
        at += 1
        if length == 15 then
          var more = 255
          while more == 255 && at < until do
            more = source(at) & 0xff
            length = grown(length, more)
            at += 1
          if more == 255 then short()
        if open then
          if length > until - at then
            if cut then
              length = until - at
            else throw Damaged(s"$length literals where its block has ${until - at} bytes left")
          if length > limit - out then throw Damaged("more bytes than it claims")
          System.arraycopy(source, at, target, out, length)
          at += length
          out += length
          if at == until then open = false
          else if until - at < 2 then short()
          else
            val distance = (source(at) & 0xff) | (source(at + 1) & 0xff) << 8
            at += 2
            var copied = (token & 15) + MinMatch
            if (token & 15) == 15 then
              var more = 255
              while more == 255 && at < until do
                more = source(at) & 0xff
                copied = grown(copied, more)
                at += 1
              if more == 255 then short()
            if open then
              if distance == 0 || distance > out - oldest then
                throw Damaged(s"a match $distance bytes back where there are ${out - oldest}")
              if copied > limit - out then throw Damaged("more bytes than it claims")
              copyBack(target, out, distance, copied)
              out += copied
    out

  private def grown(length: Int, more: Int): Int =
    val sum = length + more
    if sum < 0 then throw Damaged("a length beyond 2 GB") else sum

  private def copyBack(target: Array[Byte], to: Int, distance: Int, length: Int): Unit =
    if distance >= length then System.arraycopy(target, to - distance, target, to, length)
    else if distance == 1 then Arrays.fill(target, to, to + length, target(to - 1))
    else
      // The pattern repeats: what is already copied doubles each time.
      var done = distance.min(length)
      System.arraycopy(target, to - distance, target, to, done)
      while done < length do
        val next = done.min(length - done)
        System.arraycopy(target, to, target, to + done, next)
        done += next

/** What a compressed chunk holds instead of what it should. */
private[mcap] final class Damaged(why: String) extends RuntimeException(why)
    with scala.util.control.NoStackTrace
