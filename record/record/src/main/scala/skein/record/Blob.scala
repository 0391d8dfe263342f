package skein.record

import com.github.luben.zstd.{Zstd, ZstdException}
import java.lang.ref.WeakReference
import java.util.Arrays
import java.util.zip.CRC32

/** What an image or a cloud consists of: bytes that nobody changes any more. They are kept as they came, or
  * compressed by Zstandard, as recordings hold them. Equal where the bytes are.
  *
  * @param size of the bytes
  */
final class Blob private (kept: Array[Byte], isPacked: Boolean, val size: Int):

  // Who opens a frame looks whether it is whole, and mostly wants its bytes at once.
  private var open = WeakReference[Array[Byte]](null)

  /** Decompressed where they are kept compressed, again if nobody holds them any more. Nobody changes what
    * comes.
    */
  def bytes: Array[Byte] =
    if !isPacked then kept
    else
      Option(open.get).getOrElse:
        val bytes = Zstd.decompress(kept, size)
        open = WeakReference(bytes)
        bytes

  /** A frame of Zstandard that says its size. */
  def packed: Array[Byte] = if isPacked then kept else Zstd.compress(kept, Blob.Level)

  /** The same, kept compressed. */
  def compressed: Blob = if isPacked then this else new Blob(packed, isPacked = true, size)

  override def equals(other: Any): Boolean = other match
    case that: Blob => size == that.size && Arrays.equals(bytes, that.bytes)
    case _          => false

  override def hashCode: Int      = Arrays.hashCode(bytes)
  override def toString(): String = s"$size bytes"

object Blob:
  /** Of the bytes of one, more than any image of 8192 × 8192 pixels has. */
  val MostBytes: Int = 256 * 1024 * 1024

  /** The quickest. */
  private val Level = 1

  private[record] def crc(blob: Blob): Long =
    val crc = CRC32()
    crc.update(blob.bytes)
    crc.getValue

  /** The array must not change any more. */
  def of(bytes: Array[Byte]): Blob = new Blob(bytes, isPacked = false, bytes.length)

  /** Of what [[Blob.packed]] gave.
    *
    * @return or what is wrong with it
    */
  def ofPacked(packed: Array[Byte]): Either[String, Blob] =
    val size = Zstd.getFrameContentSize(packed)
    if size < 0 then Left(s"expected a frame of Zstandard that says its size, came ${packed.length} others")
    else if size > MostBytes then Left(s"expected up to $MostBytes bytes, came a frame of $size")
    else
      val blob = new Blob(packed, isPacked = true, size.toInt)
      try
        val _ = blob.bytes
        Right(blob)
      catch case damaged: ZstdException => Left(s"a frame of Zstandard is damaged: ${damaged.getMessage}")
