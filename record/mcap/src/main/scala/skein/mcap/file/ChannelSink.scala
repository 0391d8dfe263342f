package skein.mcap.file

import java.nio.ByteBuffer
import java.nio.channels.WritableByteChannel
import skein.mcap.ByteSink

/** Writes to a channel; blocks while the channel does. Throws the channel's `IOException`. */
final class ChannelSink(channel: WritableByteChannel) extends ByteSink:
  def write(array: Array[Byte], from: Int, until: Int): Unit =
    val bytes = ByteBuffer.wrap(array, from, until - from)
    while bytes.hasRemaining do channel.write(bytes): Unit
