package skein.record

import java.nio.file.Path
import java.util.concurrent.ThreadFactory
import java.util.concurrent.atomic.{AtomicLong, AtomicReference}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.dispatch.Dispatchers
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.{Failure, Success}

/** Writes a flight into one DuckDB file while it flies, and gives its rows to others who write them
  * elsewhere. Records wait in a bounded queue; a thread of its own commits them at once, but not oftener than
  * every [[DuckDbRecorder.commitInterval]], and [[DuckDbRecorder.batchSize]] rows at most. What is committed
  * survives a kill of the process.
  */
final class DuckDbRecorder private (
    capacity: Int,
    writer: RecordWriter,
    waitingBytes: AtomicLong,
    failed: Promise[RecordError],
    ending: AtomicReference[Option[Ending]],
    closing: Promise[Unit],
    closed: Future[Either[RecordError, Written]]
) extends Recorder:

  def offer(record: Recordable): Unit = record match
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

  private def enqueue(record: Recordable): Unit =
    if !writer.offer(record) then
      failed.trySuccess(RecordError.QueueFull(capacity)): Unit
      // What is queued already is still written; what comes now would leave a gap.
      writer.end()

  def failure: Future[RecordError] = failed.future

  def close(): Future[Either[RecordError, Written]] =
    writer.end()
    closing.trySuccess(()): Unit
    closed

object DuckDbRecorder:

  /** Records that may wait to be written: at 20 vehicles and 10 Hz about a minute. */
  val defaultCapacity = 65536

  /** Of images and clouds among them: two seconds of four cameras of 640 × 480 pixels at 10 Hz. What comes
    * then is left out, and is an event.
    */
  val mostWaitingBytes: Long = 96L * 1024 * 1024

  /** From the begin of one commit to that of the next. A kill of the process loses this and the time that a
    * commit takes: 45 to 165 ms at a load of 12 to 16 on two cores.
    */
  val commitInterval: FiniteDuration = 25.millis

  /** Rows committed at once at the most. */
  val batchSize = 4096

  /** Whether a recording can be begun there, as far as its name tells; else why not. */
  def free(file: Path): Either[RecordError, Unit] = RecordingFile.free(file)

  /** Makes the file and begins to record. Fails if there is a file already, or if it cannot be made.
    *
    * @param beside get every row that is committed, and are closed with this
    * @param threads makes the thread that writes
    */
  def open(
      file: Path,
      heading: RecordingHeader,
      capacity: Int = defaultCapacity,
      beside: Vector[RowSink] = Vector.empty,
      threads: ThreadFactory = usual
  )(using
      system: ActorSystem
  ): Future[Either[RecordError, DuckDbRecorder]] =
    given ExecutionContext = system.dispatchers.lookup(Dispatchers.DefaultBlockingDispatcherId)
    Future(RecordingFile.create(file, heading)).map(_.map: made =>
      val rows = Numbered(beside)
      rows.put(heading.records)
      start(made, capacity, rows, threads))

  private val usual: ThreadFactory = Thread.ofPlatform().daemon().name("skein-record-", 1).factory()

  private def start(file: RecordingFile, capacity: Int, rows: Numbered, threads: ThreadFactory)(using
      ExecutionContext
  ): DuckDbRecorder =
    val failed       = Promise[RecordError]()
    val ending       = AtomicReference(Option.empty[Ending])
    val closing      = Promise[Unit]()
    val waitingBytes = AtomicLong()
    val writer       = RecordWriter(capacity, commitInterval.toNanos, batchSize, threads): batch =>
      val written = file.write(batch)
      written.left.foreach(failed.trySuccess)
      if written.isRight then rows.put(batch)
      for blob <- batch.iterator.flatMap(Record.blobOf) do waitingBytes.addAndGet(-blob.size): Unit
      written.isRight
    def finish(): Either[RecordError, Written] =
      for last <- ending.get do
        file.end(last).left.foreach(failed.trySuccess)
        rows.put(Seq(last))
      rows.close()
      val written = file.close()
      written.left.foreach(failed.trySuccess)
      failed.future.value.fold(written)(reason => Left(reason.get))
    val closed = writer.ended.transformWith:
      case Success(_)      => closing.future.map(_ => finish())
      case Failure(reason) =>
        failed.trySuccess(RecordError.WriteFailed(file.path, reason.toString)): Unit
        Future.successful(finish())
    DuckDbRecorder(capacity, writer, waitingBytes, failed, ending, closing, closed)

  /** Numbers rows as the file does, for those beside it. */
  private final class Numbered(beside: Vector[RowSink]):
    private var next = 0L

    def put(records: Seq[Record]): Unit =
      val rows = records.zipWithIndex.map((record, index) => (next + index, record))
      next += records.size
      beside.foreach(_.put(rows))

    def close(): Unit = beside.foreach(_.close())
