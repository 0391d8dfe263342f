package skein.torture

import scala.collection.mutable
import scala.concurrent.{Future, Promise}
import skein.record.*
import skein.units.*

/** Passes records on to `recorder`, onto a [[Disk]] that may block or fail: then rows wait in a bounded
  * queue, and when that is full, the recording has failed.
  */
final class FaultyRecorder(recorder: Recorder, disk: Disk, clock: Clock, start: Instant) extends Recorder:
  private val failed  = Promise[RecordError]()
  private val taken   = mutable.ArrayBuffer.empty[Record]
  private var waiting = 0

  /** The records offered up to the first that could not be kept: the recording must hold these. */
  def offered: Vector[Record] = taken.toVector

  def offer(record: Recordable): Unit = record.row match
    case last: Ending => recorder.offer(last)
    case row          =>
      if !failed.isCompleted then
        write(row)
        if !failed.isCompleted then taken += row

  private def write(record: Record): Unit =
    val now = clock.now().since(start)
    disk match
      case Disk.Fails(at) if now >= at =>
        fail(RecordError.WriteFailed(FaultyRecorder.file, "the disk is full"))
      case Disk.Blocks(at, lasts, capacity) if now >= at && now < at + lasts =>
        waiting += 1
        if waiting > capacity then fail(RecordError.QueueFull(capacity)) else recorder.offer(record)
      case _ => recorder.offer(record)

  def failure: Future[RecordError]                  = failed.future
  def close(): Future[Either[RecordError, Written]] = recorder.close()

  private def fail(error: RecordError): Unit = { val _ = failed.trySuccess(error) }

private object FaultyRecorder:
  private val file = java.nio.file.Path.of("flight.duckdb")
