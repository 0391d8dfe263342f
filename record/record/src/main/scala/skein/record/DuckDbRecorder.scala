package skein.record

import java.nio.file.Path
import java.util.concurrent.ThreadFactory
import java.util.concurrent.atomic.{AtomicLong, AtomicReference}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.dispatch.Dispatchers
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.{Failure, Success}

/** Writes a flight into one DuckDB file while it runs, and passes its rows to other sinks. Records wait in a
  * bounded queue; a thread of its own commits them immediately, but not more often than every
  * [[DuckDbRecorder.commitInterval]], and at most [[DuckDbRecorder.batchSize]] rows at a time. Committed rows
  * survive a kill of the process; a power cut may damage the file until it is closed, since no commit waits
  * for the disk.
  */
final class DuckDbRecorder private (
    file: RecordingFile,
    capacity: Int,
    rows: DuckDbRecorder.Numbered,
    threads: ThreadFactory
)(using ExecutionContext)
    extends Recorder:
  private val failed       = Promise[RecordError]()
  private val ending       = AtomicReference(Option.empty[Ending])
  private val closing      = Promise[Unit]()
  private val waitingBytes = AtomicLong()

  private val writer =
    import DuckDbRecorder.{batchSize, commitInterval}
    RecordWriter(capacity, commitInterval.toNanos, batchSize, threads): batch =>
      val written = file.write(batch)
      written.left.foreach(failed.trySuccess)
      if written.isRight then rows.put(batch)
      for blob <- batch.iterator.flatMap(Record.blobOf) do waitingBytes.addAndGet(-blob.size): Unit
      written.isRight

  private val closed = writer.ended.transformWith:
    case Success(_)      => closing.future.map(_ => finish())
    case Failure(reason) =>
      failed.trySuccess(RecordError.WriteFailed(file.path, reason.toString)): Unit
      Future.successful(finish())

  private def finish(): Either[RecordError, Written] =
    for last <- ending.get do
      file.end(last).left.foreach(failed.trySuccess)
      rows.put(Seq(last))
    rows.close()
    val written = file.close()
    written.left.foreach(failed.trySuccess)
    failed.future.value.fold(written)(reason => Left(reason.get))

  def offer(record: Recordable): Unit = record match
    case last: Ending                 => ending.set(Some(last))
    case large: (CameraImage | Cloud) => offerLarge(large)
    case _                            => enqueue(record)

  /** Offers an image or a cloud. If the disk is slower than their arrival, it is dropped and this is
    * reported, so that the flight continues.
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
      // Queued records are still written; later ones would leave a gap.
      writer.end()

  def failure: Future[RecordError] = failed.future

  def close(): Future[Either[RecordError, Written]] =
    writer.end()
    closing.trySuccess(()): Unit
    closed

object DuckDbRecorder:

  /** Maximum number of records that wait to be written: about a minute at 20 vehicles and 10 Hz. */
  val defaultCapacity = 65536

  /** Maximum number of bytes of waiting images and clouds: two seconds of four cameras of 640 × 480 pixels at
    * 10 Hz. Later ones are dropped, and an event is recorded.
    */
  val mostWaitingBytes: Long = 96L * 1024 * 1024

  /** Time from the start of one commit to the start of the next. A kill of the process loses the rows of this
    * time and of one commit, which takes 35 to 52 ms with real-time priority at a load of 17 to 19 on two
    * cores, and 95 and 202 ms without.
    */
  val commitInterval: FiniteDuration = 25.millis

  val batchSize = 4096

  /** Checks by its name whether a recording can be created at this path; Left says why it cannot. */
  def free(file: Path): Either[RecordError, Unit] = RecordingFile.free(file)

  /** Creates the file and begins to record. Fails if the file exists, or cannot be created.
    *
    * @param beside sinks that receive every committed row, and are closed with this recorder
    * @param threads makes the writing thread
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
      DuckDbRecorder(made, capacity, rows, threads))

  private val usual: ThreadFactory = Thread.ofPlatform().daemon().name("skein-record-", 1).factory()

  /** Numbers rows as the file does, for the other sinks. */
  private final class Numbered(beside: Vector[RowSink]):
    private var next = 0L

    def put(records: Seq[Record]): Unit =
      val rows = records.zipWithIndex.map((record, index) => (next + index, record))
      next += records.size
      beside.foreach(_.put(rows))

    def close(): Unit = beside.foreach(_.close())
