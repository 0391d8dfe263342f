package skein.record

import java.util.concurrent.atomic.AtomicInteger
import java.util.concurrent.locks.LockSupport
import java.util.concurrent.{ConcurrentLinkedQueue, ThreadFactory}
import scala.annotation.tailrec
import scala.concurrent.{Future, Promise}
import scala.util.control.NonFatal

/** Writes records in batches, on a thread of its own. A batch contains all records since the last one, and
  * begins at least `interval` after that one began. Offering a record never waits, not even for a lock that
  * this thread holds while other threads run.
  *
  * @param capacity maximum number of records that wait
  * @param batchSize maximum number of records in a batch
  * @param write writes a batch; returns false to end
  */
private[record] final class RecordWriter(
    capacity: Int,
    intervalNanos: Long,
    batchSize: Int,
    threads: ThreadFactory
)(write: Vector[Record] => Boolean):
  private val waiting            = ConcurrentLinkedQueue[Recordable]()
  private val count              = AtomicInteger()
  private val over               = Promise[Unit]()
  @volatile private var isEnding = false
  @volatile private var isIdle   = false
  private val thread             = threads.newThread(() => run())
  thread.start()

  /** Completes when everything is written, or nothing more can be. */
  def ended: Future[Unit] = over.future

  /** Offers a record from any thread; ignored after [[end]].
    *
    * @return false if the queue is full
    */
  def offer(record: Recordable): Boolean =
    if isEnding then true
    else if count.incrementAndGet() > capacity then
      count.decrementAndGet(): Unit
      false
    else
      waiting.add(record): Unit
      if isIdle then LockSupport.unpark(thread)
      true

  /** Accepts no more records; waiting ones are still written. */
  def end(): Unit =
    isEnding = true
    LockSupport.unpark(thread)

  private def run(): Unit =
    try
      var begun = System.nanoTime - intervalNanos
      var goes  = true
      while goes do
        if !waiting.isEmpty then
          pause(begun + intervalNanos)
          begun = System.nanoTime
          goes = write(taken())
        else if isEnding && count.get == 0 then goes = false
        else idle()
      isEnding = true
      over.trySuccess(()): Unit
    catch
      // Out of memory, too: the end of a flight waits for this.
      case error: Throwable =>
        isEnding = true
        over.tryFailure(error): Unit
        if !NonFatal(error) then throw error

  /** Waits for records; one offered meanwhile wakes it. */
  private def idle(): Unit =
    isIdle = true
    if waiting.isEmpty then LockSupport.parkNanos(this, RecordWriter.LookNanos)
    isIdle = false

  @tailrec private def pause(until: Long): Unit =
    val left = until - System.nanoTime
    if left > 0 && !isEnding then
      LockSupport.parkNanos(this, left)
      pause(until)

  private def taken(): Vector[Record] =
    val batch = Vector.newBuilder[Record]
    var size  = 0
    var next  = waiting.poll()
    while next != null do
      count.decrementAndGet(): Unit
      batch += next.row
      size += 1
      next = if size < batchSize then waiting.poll() else null
    batch.result()

private object RecordWriter:
  private val LookNanos = 100_000_000L
