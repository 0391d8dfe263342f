package skein.view

import java.util.concurrent.{ConcurrentHashMap, ConcurrentLinkedQueue}
import java.util.concurrent.atomic.{AtomicInteger, AtomicLong}
import skein.record.{ImagingSensor, Record, Recordable}

/** Passes a flight's records to viewers. Bounded, and the newest wins; of a camera's images, and of a lidar's
  * clouds, only the newest waits. `offer` takes no lock: a suspended viewer thread cannot delay a flight.
  *
  * @param capacity maximum number of waiting records, exceeded briefly by at most one for each thread that
  *   offers
  */
final class Feed(capacity: Int = Feed.DefaultCapacity):
  private val queue   = ConcurrentLinkedQueue[Recordable]()
  private val waiting = AtomicInteger()
  private val dropped = AtomicLong()

  private val seen = ConcurrentHashMap[ImagingSensor, Record]()

  def offer(record: Recordable): Unit = record match
    case image: Record => ImagingSensor.of(image).fold(enqueue(image))(seen.put(_, image): Unit)
    case later         => enqueue(later)

  /** The newest record of a camera or a lidar, if there is one since the last call. */
  def poll(sensor: ImagingSensor): Option[Record] = Option(seen.remove(sensor))

  private def enqueue(record: Recordable): Unit =
    queue.offer(record): Unit
    if waiting.incrementAndGet() > capacity && next().isDefined then dropped.incrementAndGet(): Unit

  def poll(): Option[Record] = next().map(_.row)

  private def next(): Option[Recordable] =
    val first = Option(queue.poll())
    if first.isDefined then waiting.decrementAndGet(): Unit
    first

  def lost: Long = dropped.get

object Feed:
  /** Some seconds of twenty vehicles' records at 20 Hz. */
  val DefaultCapacity = 16384
