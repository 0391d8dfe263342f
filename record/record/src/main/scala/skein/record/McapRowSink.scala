package skein.record

import java.io.IOException
import java.nio.channels.FileChannel
import java.nio.file.StandardOpenOption.{CREATE, TRUNCATE_EXISTING, WRITE}
import java.nio.file.{Files, Path}
import scala.util.control.NonFatal
import skein.mcap.McapWriter
import skein.mcap.file.ChannelSink
import skein.scene.Scene

/** Writes a flight into an MCAP file while it runs: the messages of [[McapRecording]]'s export, one by one.
  * Until the first decision has estimated the offset between the clocks, poses are placed as if the first
  * reading had no latency. If the process ends, the file can be read up to its last second.
  */
final class McapRowSink private (channel: FileChannel, file: Path, heading: RecordingHeader, scene: Scene)
    extends RowSink:
  private val mcap = new McapWriter(ChannelSink(channel), McapRecording.options)

  @volatile private var failed = Option.empty[String]

  private lazy val flight = McapRecording.Rows(
    mcap,
    heading.vehicles.map(_.name).toVector,
    heading.flight.startedAt,
    offset = None,
    scene
  )
  private var batches = 0L

  def put(rows: Seq[(Long, Record)]): Unit = attempt:
    rows.foreach(flight.put)
    batches += 1
    if batches % McapRowSink.FlushEvery == 0 then mcap.flush()

  def close(): Unit =
    attempt(mcap.finish())
    try channel.close()
    catch case error: IOException => failed = failed.orElse(Some(why(error)))

  def discard(): Unit =
    try Files.deleteIfExists(file): Unit
    catch case error: IOException => failed = failed.orElse(Some(why(error)))

  def failure: Option[String] = failed

  private def attempt(write: => Unit): Unit = if failed.isEmpty then
    try write
    // Whatever the error, the recording continues.
    catch case NonFatal(error) => failed = Some(why(error))

  private def why(error: Throwable) = s"cannot write $file: $error"

object McapRowSink:
  /** Number of commits between two flushes, about one second of them. */
  private val FlushEvery = 40

  /** Creates the file, which must not exist yet.
    *
    * @param scene the scene of the flight's world
    */
  def open(
      file: Path,
      heading: RecordingHeader,
      scene: Scene = Scene.Empty
  ): Either[RecordError, McapRowSink] =
    if Files.exists(file) then Left(RecordError.AlreadyExists(file))
    else
      FileReason.attempt(RecordError.CannotCreate(file, _)):
        McapRowSink(FileChannel.open(file, CREATE, TRUNCATE_EXISTING, WRITE), file, heading, scene)
