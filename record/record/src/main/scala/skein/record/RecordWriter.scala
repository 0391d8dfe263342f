package skein.record

import java.util.concurrent.atomic.AtomicInteger
import java.util.concurrent.locks.LockSupport
import java.util.concurrent.{ConcurrentLinkedQueue, ThreadFactory}
import scala.annotation.tailrec
import scala.concurrent.{Future, Promise}
import scala.util.control.NonFatal

/** Writes records in batches, on a thread of its own: what has come since the last batch, `interval` after
  * that began at the earliest. Whoever offers a record never waits, not even for a lock that this thread
  * holds while others run.
  *
  * @param capacity records that may wait
  * @param batchSize most records of a batch
  * @param write of a batch; false to end
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

  /** Completes when all is written, or nothing more can be. */
  def ended: Future[Unit] = over.future

  /** From any thread; ignored after [[end]].
    *
    * @return false where as many wait as may
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

  /** Nothing more is taken; what waits is still written. */
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
    catch case NonFatal(error) => over.tryFailure(error): Unit

  /** One that is offered meanwhile ends it. */
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
