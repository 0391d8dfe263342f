package skein.record

import com.github.luben.zstd.{Zstd, ZstdException}
import java.lang.ref.WeakReference
import java.util.Arrays
import java.util.zip.CRC32

/** The content of an image or a cloud: immutable bytes, kept as received, or compressed by Zstandard as in
  * recordings. Equal if the bytes are.
  *
  * @param size number of bytes, uncompressed
  */
final class Blob private (kept: Array[Byte], isPacked: Boolean, val size: Int):

  // Opening a frame checks that it is complete, and its bytes are usually read immediately afterwards.
  private var open = WeakReference[Array[Byte]](null)

  /** The bytes, which must not be changed. If they are kept compressed, they are decompressed here, and once
    * more after the result was garbage-collected.
    */
  def bytes: Array[Byte] =
    if !isPacked then kept
    else
      Option(open.get).getOrElse:
        val bytes = Zstd.decompress(kept, size)
        open = WeakReference(bytes)
        bytes

  /** The bytes as a Zstandard frame that states its size. */
  def packed: Array[Byte] = if isPacked then kept else Zstd.compress(kept, Blob.Level)

  /** This content, kept compressed from now on. */
  def compressed: Blob = if isPacked then this else new Blob(packed, isPacked = true, size)

  override def equals(other: Any): Boolean = other match
    case that: Blob => size == that.size && Arrays.equals(bytes, that.bytes)
    case _          => false

  override def hashCode: Int      = Arrays.hashCode(bytes)
  override def toString(): String = s"$size bytes"

object Blob:
  /** Maximum size of one content in bytes: that of an image of 8192 × 8192 pixels of 4 bytes. */
  val MostBytes: Int = 256 * 1024 * 1024

  private val Level = 1

  private[record] def crc(blob: Blob): Long =
    val crc = CRC32()
    crc.update(blob.bytes)
    crc.getValue

  /** A view of an array, which must not change any more. */
  def of(bytes: Array[Byte]): Blob = new Blob(bytes, isPacked = false, bytes.length)

  /** Content from the result of [[Blob.packed]].
    *
    * @return Left says what is wrong with it
    */
  def ofPacked(packed: Array[Byte]): Either[String, Blob] =
    val size = Zstd.getFrameContentSize(packed)
    if size < 0 then Left(s"expected a frame of Zstandard that says its size, got ${packed.length} others")
    else if size > MostBytes then Left(s"expected up to $MostBytes bytes, got a frame of $size")
    else
      val blob = new Blob(packed, isPacked = true, size.toInt)
      try
        val _ = blob.bytes
        Right(blob)
      catch case damaged: ZstdException => Left(s"a frame of Zstandard is damaged: ${damaged.getMessage}")
