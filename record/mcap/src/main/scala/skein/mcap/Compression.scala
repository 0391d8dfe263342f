package skein.mcap

import com.github.luben.zstd.{Zstd as Zstandard, ZstdException, ZstdInputStream}
import java.io.{ByteArrayInputStream, IOException}
import java.util.Arrays

/** The compression of a chunk's records.
  *
  * @param name its name in a chunk's header
  */
enum Compression(val name: String):
  case Uncompressed extends Compression("")

  /** LZ4 frames: fast, and a third to a half larger than `Zstd`. */
  case Lz4 extends Compression("lz4")

  /** Zstandard; levels from 1, the fastest, to 22. */
  case Zstd(level: Int = 1) extends Compression("zstd")

  private[mcap] def compress(array: Array[Byte], from: Int, until: Int): Bytes = this match
    case Uncompressed => Bytes.of(array, from, until)
    case Lz4          => Lz4Frame.compress(array, from, until)
    case Zstd(level)  =>
      val target = new Array[Byte](Math.toIntExact(Zstandard.compressBound(until - from)))
      val size   = Zstandard.compressByteArray(target, 0, target.length, array, from, until - from, level)
      Bytes.of(target, 0, size.toInt)

object Compression:
  /** Greatest expansion of LZ4: a byte represents no more than 255. */
  private val Lz4Ratio = 255L

  /** Greatest expansion of Zstandard: four bytes, a block of one value, represent no more than 128 KiB. */
  private val ZstdRatio = 32768L

  /** Decompresses a chunk's records to the size that the chunk states; of a truncated chunk (`cut`), the
    * bytes that are left.
    */
  private[mcap] def decompress(
      chunk: Record.Chunk,
      limits: McapLimits,
      at: Place,
      cut: Boolean = false
  ): Bytes =
    limits.hold(chunk.uncompressedSize, limits.chunkBytes, "a chunk, uncompressed,", at)
    val size = chunk.uncompressedSize.toInt
    val out  =
      try
        chunk.compression match
          case ""    => chunk.records
          case "lz4" =>
            possible(chunk, Lz4Ratio, cut)
            Lz4Frame.decompress(chunk.records, size, cut)
          case "zstd" =>
            possible(chunk, ZstdRatio, cut)
            if cut then beginningOfZstd(chunk.records, size) else zstd(chunk.records, size)
          case other => throw Refused(McapError.UnknownCompression(at, other))
      catch
        case damaged: Damaged =>
          throw Refused(McapError.NotDecompressed(at, chunk.compression, damaged.getMessage))
    if !cut then
      if out.size != size then
        Refused.malformed(at, s"a chunk of $size bytes, uncompressed", s"${out.size} bytes")
      if chunk.uncompressedCrc != 0 then
        val computed = Checksum.of(out.array, out.from, out.from + out.size)
        Checksum.hold(chunk.uncompressedCrc, computed, "the chunk's records, uncompressed,", at)
    out

  /** Refuses, before allocating, a size that these bytes cannot expand to. */
  private def possible(chunk: Record.Chunk, ratio: Long, cut: Boolean): Unit =
    if !cut && chunk.uncompressedSize > chunk.records.size * ratio then
      throw Damaged(s"${chunk.records.size} bytes, which cannot be ${chunk.uncompressedSize}")

  private def zstd(records: Bytes, size: Int): Bytes =
    val told = Zstandard.getFrameContentSize(records.array, records.from, records.size)
    if told > size then throw Damaged(s"a frame of $told bytes where the chunk has $size")
    val target = new Array[Byte](size)
    val filled =
      try Zstandard.decompressByteArray(target, 0, size, records.array, records.from, records.size)
      catch case damaged: ZstdException => throw Damaged(s"bytes of which it says \"${damaged.getMessage}\"")
    Bytes.of(target, 0, filled.toInt)

  private def beginningOfZstd(records: Bytes, size: Int): Bytes =
    val target = new Array[Byte](size)
    val input  =
      ZstdInputStream(ByteArrayInputStream(records.array, records.from, records.size)).setContinuous(true)
    try
      var have = 0
      var more = true
      while more && have < size do
        val count =
          try input.read(target, have, size - have)
          catch case _: IOException | _: ZstdException => -1
        if count <= 0 then more = false else have += count
      Bytes.of(Arrays.copyOf(target, have), 0, have)
    finally input.close()
