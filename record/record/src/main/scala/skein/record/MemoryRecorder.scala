package skein.record

import java.nio.file.Path
import scala.collection.mutable.ArrayBuffer
import scala.concurrent.{Future, Promise}

/** Keeps a flight in memory: for virtual time, where writing would be the slowest part, and for tests.
  *
  * @param capacity maximum number of records; a further record is a failure
  */
final class MemoryRecorder(heading: RecordingHeader, capacity: Int = MemoryRecorder.defaultCapacity)
    extends Recorder:
  private val kept   = ArrayBuffer.empty[Record]
  private var closed = false
  private val failed = Promise[RecordError]()

  /** Makes the row immediately, because it is smaller than the decision. In virtual time no command waits for
    * it.
    */
  def offer(record: Recordable): Unit = keep(record.row match
    // Many would not fit otherwise.
    case image: CameraImage => image.copy(pixels = image.pixels.compressed)
    case cloud: Cloud       => cloud.copy(xyz = cloud.xyz.compressed)
    case other              => other)

  private def keep(record: Record): Unit = synchronized:
    if record.isInstanceOf[Ending] && failed.isCompleted then kept += record: Unit
    else if !closed then
      if kept.size < capacity then kept += record: Unit
      else
        closed = true
        val _ = failed.trySuccess(RecordError.MemoryFull(capacity))

  def failure: Future[RecordError] = failed.future

  def close(): Future[Either[RecordError, Written]] = synchronized:
    closed = true
    Future.successful:
      failed.future.value match
        case Some(reason) => Left(reason.get)
        case None         => Right(Written.nothing ++ (heading.records ++ records).map(Table.of(_).name))

  def records: Vector[Record] = synchronized(kept.toVector)

  /** The recording so far, sorted by kind. */
  def recording: Recording = Recording(heading, records)

  /** The heading's records, followed by those recorded since. */
  def all: Iterator[Record] = heading.records.iterator ++ records

  /** The digest of the file that [[writeTo]] would write. */
  def digest: Digest = Digest.of(all)

  /** Writes the file that a [[DuckDbRecorder]] would have written. Blocks. */
  def writeTo(file: Path): Either[RecordError, Written] =
    for
      opened <- RecordingFile.create(file, heading)
      outcome = opened.write(records)
      written <- opened.close()
      _       <- outcome
    yield written

object MemoryRecorder:

  /** About 1 GB of records, which 20 vehicles at 10 Hz produce in an hour. */
  val defaultCapacity = 4_000_000
