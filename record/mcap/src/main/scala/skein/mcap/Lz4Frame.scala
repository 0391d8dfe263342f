package skein.mcap

import java.nio.{ByteBuffer, ByteOrder}
import java.util.Arrays

/** LZ4 frames (https://github.com/lz4/lz4/blob/dev/doc/lz4_Frame_format.md), to and from one array. Reads
  * every frame that needs no dictionary, with blocks that look back into earlier ones and without, one behind
  * another, and steps over skippable ones. Writes blocks of at most 4 MiB, each for itself, and the size of
  * the content.
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
  private val FourMiB         = 4 << 20

  def compress(source: Array[Byte], from: Int, until: Int): Bytes =
    val length = until - from
    val blocks = (length.toLong + FourMiB - 1) / FourMiB
    val target = new Array[Byte](Math.toIntExact(19 + 4 + length.toLong + blocks * (4 + FourMiB / 255 + 16)))
    val view   = ByteBuffer.wrap(target).order(ByteOrder.LITTLE_ENDIAN)
    view.putInt(0, Number)
    target(4) = (Version | Independent | ContentSize).toByte
    target(5) = (7 << 4).toByte
    view.putLong(6, length)
    target(14) = (XxHash32.of(target, 4, 14) >>> 8).toByte
    val memory = Lz4Block.Memory()
    var out    = 15
    var at     = from
    while at < until do
      val end     = until.min(at + FourMiB)
      val written = Lz4Block.compress(source, at, end, target, out + 4, memory)
      if written - out - 4 < end - at then
        view.putInt(out, written - out - 4)
        out = written
      else
        view.putInt(out, (end - at) | Stored)
        System.arraycopy(source, at, target, out + 4, end - at)
        out += 4 + end - at
      at = end
    view.putInt(out, 0)
    Bytes.of(target, 0, out + 4)

  /** What the frames hold, at most `size` bytes. Throws `Damaged`; where they are cut off (`cut`), gives what
    * there is.
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

    /** Whether so many bytes are left; where not, and the frames may be cut off, that was all. */
    private def has(count: Long): Boolean =
      val there = count <= until - at
      if !there then
        if cut then ended = true
        else throw Damaged(s"a frame that ends where ${count - (until - at)} bytes miss")
      there

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
      if (flags & VersionMask) != Version then throw Damaged(s"a frame of version ${flags >>> 6}, not 1")
      if (flags & Dictionary) != 0 then throw Damaged("a frame that needs a dictionary")
      val header = 2 + (if (flags & ContentSize) != 0 then 8 else 0)
      if has(4L + header + 1) then
        val checksum = (XxHash32.of(source, at + 4, at + 4 + header) >>> 8) & 0xff
        if checksum != (source(at + 4 + header) & 0xff) then
          throw Damaged("a frame whose header's checksum differs")
        at += 4 + header + 1
        val start = out
        var open  = true
        while open && !ended do open = block(flags, start)
        if !ended && (flags & ContentChecksum) != 0 && has(4) then
          val written = view.getInt(at)
          if XxHash32.of(target, start, out) != written then
            throw Damaged("a frame whose content's checksum differs")
          at += 4

    /** Whether another follows. */
    private def block(flags: Int, start: Int): Boolean =
      has(4) && {
        val word   = view.getInt(at)
        val length = word & ~Stored
        at += 4
        word != 0 && {
          val there = length.min(until - at)
          if there < length && !cut then throw Damaged(s"a block of $length bytes where $there are left")
          val oldest = if (flags & Independent) != 0 then out else start
          if (word & Stored) == 0 then
            out = Lz4Block.decompress(source, at, at + there, target, out, size, oldest, there < length)
          else if there > size - out then throw Damaged("more bytes than it claims")
          else
            System.arraycopy(source, at, target, out, there)
            out += there
          if (flags & BlockChecksum) != 0 && there == length then checkBlock(length)
          at += there + (if (flags & BlockChecksum) != 0 && there == length then 4 else 0)
          if there < length then ended = true
          !ended
        }
      }

    private def checkBlock(length: Int): Unit =
      if until - at - length < 4 then
        if cut then ended = true else throw Damaged("a frame that ends within a block's checksum")
      else if XxHash32.of(source, at, at + length) != view.getInt(at + length) then
        throw Damaged("a block whose checksum differs")
