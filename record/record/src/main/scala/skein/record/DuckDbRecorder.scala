package skein.record

import java.nio.file.Path
import java.util.concurrent.atomic.{AtomicLong, AtomicReference}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.dispatch.Dispatchers
import org.apache.pekko.stream.scaladsl.{Keep, Sink, Source}
import org.apache.pekko.stream.{ActorAttributes, BoundedSourceQueue, QueueOfferResult}
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.{Failure, Success}

/** Writes a flight into one DuckDB file while it flies, and gives its rows to others who write them
  * elsewhere. Records wait in a bounded queue; a stream of its own, on the dispatcher for blocking work,
  * commits them every [[DuckDbRecorder.commitInterval]] or every [[DuckDbRecorder.batchSize]] rows. What is
  * committed survives a kill of the process.
  */
final class DuckDbRecorder private (
    capacity: Int,
    queue: BoundedSourceQueue[Record],
    waitingBytes: AtomicLong,
    failed: Promise[RecordError],
    ending: AtomicReference[Option[Ending]],
    closing: Promise[Unit],
    closed: Future[Either[RecordError, Written]]
) extends Recorder:

  def offer(record: Record): Unit = record match
    case last: Ending                 => ending.set(Some(last))
    case large: (CameraImage | Cloud) => offerLarge(large)
    case _                            => enqueue(record)

  /** Images and clouds are left out, and told of, where the disk is slower than they come: the flight goes
    * on.
    */
  private def offerLarge(record: CameraImage | Cloud): Unit =
    val (vehicle, name, at) = record match
      case one: CameraImage => (one.vehicle, one.camera, one.receivedAt)
      case one: Cloud       => (one.vehicle, one.lidar, one.receivedAt)
    val size = Record.blobOf(record).fold(0)(_.size)
    if waitingBytes.addAndGet(size) <= DuckDbRecorder.mostWaitingBytes then enqueue(record)
    else
      val waiting = waitingBytes.addAndGet(-size)
      val why     = s"$name: not recorded, since $waiting bytes of images and clouds wait to be written"
      enqueue(Event(at, EventKind.Dropped, Some(vehicle), why))

  private def enqueue(record: Record): Unit =
    queue.offer(record) match
      case QueueOfferResult.Dropped =>
        val _ = failed.trySuccess(RecordError.QueueFull(capacity))
        // What is queued already is still written; what comes now would leave a gap.
        queue.complete()
      case QueueOfferResult.Enqueued | QueueOfferResult.QueueClosed | QueueOfferResult.Failure(_) => ()

  def failure: Future[RecordError] = failed.future

  def close(): Future[Either[RecordError, Written]] =
    if !queue.isCompleted then queue.complete()
    closing.trySuccess(()): Unit
    closed

object DuckDbRecorder:

  /** Records that may wait to be written: at 20 vehicles and 10 Hz about a minute. */
  val defaultCapacity = 65536

  /** Of images and clouds among them: two seconds of four cameras of 640 × 480 pixels at 10 Hz. What comes
    * then is left out, and is an event.
    */
  val mostWaitingBytes: Long = 96L * 1024 * 1024

  /** With the time that a commit takes, a kill of the process loses less than 200 ms. */
  val commitInterval: FiniteDuration = 50.millis

  /** Rows committed at once at the most. */
  val batchSize = 4096

  /** Whether a recording can be begun there, as far as its name tells; else why not. */
  def free(file: Path): Either[RecordError, Unit] = RecordingFile.free(file)

  /** Makes the file and begins to record. Fails if there is a file already, or if it cannot be made.
    *
    * @param beside get every row that is committed, and are closed with this
    */
  def open(
      file: Path,
      heading: RecordingHeader,
      capacity: Int = defaultCapacity,
      beside: Vector[RowSink] = Vector.empty
  )(using
      system: ActorSystem
  ): Future[Either[RecordError, DuckDbRecorder]] =
    given ExecutionContext = system.dispatchers.lookup(Dispatchers.DefaultBlockingDispatcherId)
    Future(RecordingFile.create(file, heading)).map(_.map: made =>
      val rows = Numbered(beside)
      rows.put(heading.records)
      start(made, capacity, rows))

  private def start(file: RecordingFile, capacity: Int, rows: Numbered)(using
      ActorSystem,
      ExecutionContext
  ): DuckDbRecorder =
    val failed           = Promise[RecordError]()
    val ending           = AtomicReference(Option.empty[Ending])
    val closing          = Promise[Unit]()
    val waitingBytes     = AtomicLong()
    val (queue, drained) = Source
      .queue[Record](capacity)
      .groupedWithin(batchSize, commitInterval)
      .map: batch =>
        val written = file.write(batch)
        if written.isRight then rows.put(batch)
        for blob <- batch.iterator.flatMap(Record.blobOf) do waitingBytes.addAndGet(-blob.size): Unit
        written
      .takeWhile(_.isRight, inclusive = true)
      .toMat(Sink.foreach(_.left.foreach(failed.trySuccess)))(Keep.both)
      .addAttributes(ActorAttributes.dispatcher(Dispatchers.DefaultBlockingDispatcherId))
      .run()
    def finish(): Either[RecordError, Written] =
      for last <- ending.get do
        file.end(last).left.foreach(failed.trySuccess)
        rows.put(Seq(last))
      rows.close()
      val written = file.close()
      written.left.foreach(failed.trySuccess)
      failed.future.value.fold(written)(reason => Left(reason.get))
    val closed = drained.transformWith:
      case Success(_) => closing.future.map(_ => finish())
      // The stream itself fails when its actor system ends before it.
      case Failure(reason) =>
        failed.trySuccess(RecordError.WriteFailed(file.path, reason.toString)): Unit
        Future.successful(finish())
    DuckDbRecorder(capacity, queue, waitingBytes, failed, ending, closing, closed)

  /** Numbers rows as the file does, for those beside it. */
  private final class Numbered(beside: Vector[RowSink]):
    private var next = 0L

    def put(records: Seq[Record]): Unit =
      val rows = records.zipWithIndex.map((record, index) => (next + index, record))
      next += records.size
      beside.foreach(_.put(rows))

    def close(): Unit = beside.foreach(_.close())
