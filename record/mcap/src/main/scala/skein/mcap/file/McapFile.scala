package skein.mcap.file

import java.nio.channels.FileChannel
import java.nio.file.StandardOpenOption.{CREATE, READ, TRUNCATE_EXISTING, WRITE}
import java.nio.file.Path
import scala.util.Using
import skein.mcap.*

/** Reads and writes MCAP files on a disk. Errors of the disk itself are thrown as `IOException`. */
object McapFile:

  /** Creates or replaces a file with the records that `body` writes. The file is complete once `body` has
    * returned; if `body` throws, the file can be read up to the last chunk.
    */
  def write[A](path: Path, options: WriterOptions = WriterOptions())(body: McapWriter => A): A =
    Using.resource(FileChannel.open(path, CREATE, TRUNCATE_EXISTING, WRITE)): channel =>
      val writer = McapWriter(ChannelSink(channel), options)
      val result = body(writer)
      writer.finish()
      result

  /** Reads the messages that `wanted` accepts, in the file's order. They end after an error. They must not be
    * used after `body` returns.
    */
  def read[A](path: Path, wanted: TopicMessage => Boolean = _ => true, limits: McapLimits = McapLimits())(
      body: Iterator[Either[McapError, TopicMessage]] => A
  ): A = stream(path, limits)(records => body(records.messages.filter(_.forall(wanted))))

  /** Reads all records in the file's order and verifies every CRC; the stream must not be used after `body`
    * returns.
    */
  def stream[A](path: Path, limits: McapLimits = McapLimits())(body: RecordStream => A): A =
    Using.resource(FileChannel.open(path, READ))(channel => body(RecordStream(channel, limits)))
