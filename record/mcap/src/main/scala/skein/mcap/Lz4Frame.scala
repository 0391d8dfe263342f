package skein.mcap

import java.io.ByteArrayOutputStream
import java.nio.{ByteBuffer, ByteOrder}
import java.util.Arrays
import net.jpountz.lz4.{LZ4Exception, LZ4Factory, LZ4FrameOutputStream}
import net.jpountz.lz4.LZ4FrameOutputStream.{BLOCKSIZE, FLG}
import net.jpountz.xxhash.XXHashFactory

/** LZ4 frames (https://github.com/lz4/lz4/blob/dev/doc/lz4_Frame_format.md), to and from one array. Blocks
  * and checksums are computed by lz4-java. That library's own reader of frames refuses blocks that refer to
  * earlier ones, which the MCAP libraries for C++ and Python write.
  */
private[mcap] object Lz4Frame:
  private val Number          = 0x184d2204
  private val Skippable       = 0x184d2a50
  private val VersionMask     = 0xc0
  private val Version         = 0x40
  private val Independent     = 0x20
  private val BlockChecksum   = 0x10
  private val ContentSize     = 0x08
  private val ContentChecksum = 0x04
  private val Dictionary      = 0x01
  private val Stored          = 0x80000000
  private val MaxDistance     = 65535
  private val MinMatch        = 4

  private val blocks = LZ4Factory.fastestInstance.safeDecompressor
  private val sums   = XXHashFactory.fastestInstance.hash32

  /** Compresses to one frame of independent blocks of 64 KiB: of a truncated frame, all blocks but the last
    * can be read.
    */
  def compress(source: Array[Byte], from: Int, until: Int): Bytes =
    val out   = ByteArrayOutputStream((until - from) / 2 + 64)
    val frame =
      LZ4FrameOutputStream(
        out,
        BLOCKSIZE.SIZE_64KB,
        until - from,
        FLG.Bits.BLOCK_INDEPENDENCE,
        FLG.Bits.CONTENT_SIZE
      )
    frame.write(source, from, until - from)
    frame.close()
    Bytes.of(out.toByteArray)

  /** The frames' content, at most `size` bytes. Throws `Damaged`; of truncated frames (`cut`), returns the
    * blocks before the cut.
    */
  def decompress(source: Bytes, size: Int, cut: Boolean): Bytes =
    Reading(source.array, source.from, source.from + source.size, size, cut).all()

  private final class Reading(source: Array[Byte], from: Int, until: Int, size: Int, cut: Boolean):
    private val view   = ByteBuffer.wrap(source).order(ByteOrder.LITTLE_ENDIAN)
    private val target = new Array[Byte](size)
    private var at     = from
    private var out    = 0
    private var ended  = false

    def all(): Bytes =
      while !ended && at < until do frame()
      Bytes.of(if cut then Arrays.copyOf(target, out) else target, 0, out)

    /** Whether `count` bytes are left. If not, reading ends if truncation is allowed, else fails. */
    private def has(count: Long): Boolean =
      val there = count <= until - at
      if !there then
        if cut then ended = true
        else throw Damaged(s"a frame that ends where ${count - (until - at)} bytes miss")
      there

    private def checksum(array: Array[Byte], start: Int, end: Int) = sums.hash(array, start, end - start, 0)

    private def frame(): Unit =
      if has(4) then
        val number = view.getInt(at)
        if (number & 0xfffffff0) == Skippable then
          if has(8) then
            val skipped = 8 + (view.getInt(at + 4) & 0xffffffffL)
            if has(skipped) then at += skipped.toInt
        else if number != Number then
          throw Damaged(s"a frame that begins with ${Hex.of(number)}, not ${Hex.of(Number)}")
        else if has(7) then content()

    private def content(): Unit =
      val flags = source(at + 4) & 0xff
      val most  = (source(at + 5) >>> 4) & 7
      if (flags & VersionMask) != Version then throw Damaged(s"a frame of version ${flags >>> 6}, not 1")
      if (flags & Dictionary) != 0 then throw Damaged("a frame that needs a dictionary")
      if most < 4 then throw Damaged(s"a frame whose blocks have the unknown size $most")
      val header = 2 + (if (flags & ContentSize) != 0 then 8 else 0)
      if has(4L + header + 1) then
        if ((checksum(source, at + 4, at + 4 + header) >>> 8) & 0xff) != (source(at + 4 + header) & 0xff) then
          throw Damaged("a frame whose header's checksum differs")
        at += 4 + header + 1
        val start = out
        var open  = true
        while open && !ended do open = block(flags, 1 << (8 + 2 * most), start)
        if !ended && (flags & ContentChecksum) != 0 && has(4) then
          if checksum(target, start, out) != view.getInt(at) then
            throw Damaged("a frame whose content's checksum differs")
          at += 4

    /** Reads a block of at most `most` bytes, uncompressed. Returns whether another follows. */
    private def block(flags: Int, most: Int, start: Int): Boolean =
      has(4) && {
        val word   = view.getInt(at)
        val length = word & ~Stored
        val summed = (flags & BlockChecksum) != 0
        at += 4
        word != 0 && has(length.toLong + (if summed then 4 else 0)) && {
          if summed && checksum(source, at, at + length) != view.getInt(at + length) then
            throw Damaged("a block whose checksum differs")
          val room = most.min(size - out)
          if (word & Stored) != 0 then
            if length > room then throw Damaged("more bytes than it claims")
            System.arraycopy(source, at, target, out, length)
            out += length
          else
            try out += expand(length, room, if (flags & Independent) != 0 then 0 else out - start)
            catch case _: LZ4Exception => throw Damaged("a block that is damaged, or larger than it claims")
          at += length + (if summed then 4 else 0)
          true
        }
      }

    /** Expands a block that may refer to the last `before` bytes. Returns its length. */
    private def expand(length: Int, room: Int, before: Int): Int =
      if before == 0 then blocks.decompress(source, at, length, target, out, room)
      else
        // lz4-java accepts no earlier bytes, so they precede the block: as literals, but the last four first,
        // and a match that copies these to the end. So the earlier bytes lie directly before the block's.
        val history  = before.max(MinMatch).min(MaxDistance)
        val known    = before.min(history)
        val literals = new Array[Byte](history)
        System.arraycopy(target, out - known, literals, history - known, known)
        val linked = ByteBuffer.allocate(history + history / 255 + 8 + length).order(ByteOrder.LITTLE_ENDIAN)
        linked.put((history.min(15) << 4).toByte)
        if history >= 15 then
          for _ <- 0 until (history - 15) / 255 do linked.put(255.toByte)
          linked.put(((history - 15) % 255).toByte): Unit
        linked.put(literals, history - MinMatch, MinMatch).put(literals, 0, history - MinMatch)
        linked.putShort(history.toShort).put(source, at, length)
        val expanded = new Array[Byte](MinMatch + history + room)
        val whole    = blocks.decompress(linked.array, 0, linked.position, expanded, 0, expanded.length)
        val own      = whole - MinMatch - history
        System.arraycopy(expanded, MinMatch + history, target, out, own)
        own

/** Thrown when a compressed chunk is invalid, with the reason. */
private[mcap] final class Damaged(why: String) extends RuntimeException(why)
    with scala.util.control.NoStackTrace
