package skein.view

import java.util.concurrent.ConcurrentLinkedQueue
import java.util.concurrent.atomic.{AtomicInteger, AtomicLong}
import skein.record.Record

/** Takes a flight's records to viewers. Bounded, and the newest wins. `offer` takes no lock: a viewer's thread that the
  * system has put off cannot hold up a flight.
  *
  * @param capacity
  *   records that wait; as many more as threads offer at one moment may for that moment
  */
final class Feed(capacity: Int = Feed.DefaultCapacity):
  private val queue   = ConcurrentLinkedQueue[Record]()
  private val waiting = AtomicInteger()
  private val dropped = AtomicLong()

  def offer(record: Record): Unit =
    queue.offer(record): Unit
    if waiting.incrementAndGet() > capacity && poll().isDefined then dropped.incrementAndGet(): Unit

  def poll(): Option[Record] =
    val first = Option(queue.poll())
    if first.isDefined then waiting.decrementAndGet(): Unit
    first

  /** Records that no viewer saw. */
  def lost: Long = dropped.get

object Feed:
  /** Some seconds of twenty vehicles at 20 Hz. */
  val DefaultCapacity = 16384
