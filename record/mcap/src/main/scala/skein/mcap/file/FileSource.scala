package skein.mcap.file

import java.io.EOFException
import java.nio.ByteBuffer
import java.nio.channels.FileChannel
import skein.mcap.{Bytes, ByteSource}

/** Reads anywhere in a file that does not change meanwhile. Throws the channel's `IOException`. */
final class FileSource(channel: FileChannel) extends ByteSource:
  val size: Long = channel.size

  def read(offset: Long, length: Int): Bytes =
    require(offset >= 0 && length >= 0 && offset <= size - length, s"$length bytes at $offset of $size")
    val array = new Array[Byte](length)
    val bytes = ByteBuffer.wrap(array)
    while bytes.hasRemaining do
      if channel.read(bytes, offset + bytes.position) < 0 then
        throw EOFException(s"the file had $size bytes when it was opened, and has ${channel.size}")
    Bytes.of(array)
