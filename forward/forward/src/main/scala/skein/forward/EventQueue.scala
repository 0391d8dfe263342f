package skein.forward

/** A bounded queue of events in the order of their times, ns. Events of equal times keep the order of
  * insertion, except those added by [[addLast]]. The caller defines the meaning of an event, a `Long`.
  * Allocates only when it grows.
  *
  * @throws IllegalStateException from `add` and `addLast` if the queue is full
  */
private[skein] final class EventQueue(capacity: Int):
  import java.util.Arrays.copyOf

  private var times    = Array.ofDim[Long](EventQueue.Room.min(capacity))
  private var sequence = Array.ofDim[Long](times.length)
  private var events   = Array.ofDim[Long](times.length)
  private var size     = 0
  private var added    = 0L

  def isEmpty: Boolean = size == 0

  def clear(): Unit =
    size = 0; added = 0

  def nextTime: Long = times(0)

  def add(time: Long, event: Long): Unit = add(time, event, added)

  /** Adds an event after all others of its time, even those that are added later. */
  def addLast(time: Long, event: Long): Unit = add(time, event, added | EventQueue.Last)

  private def add(time: Long, event: Long, number: Long): Unit =
    if size == times.length then makeRoom()
    var hole = size
    size += 1
    added += 1
    while hole > 0 && isBefore(time, number, (hole - 1) / 2) do
      move((hole - 1) / 2, hole)
      hole = (hole - 1) / 2
    put(hole, time, number, event)

  private def makeRoom(): Unit =
    if size == capacity then throw IllegalStateException(s"more than $capacity events are waiting")
    val room = (2 * size).min(capacity)
    times = copyOf(times, room)
    sequence = copyOf(sequence, room)
    events = copyOf(events, room)

  def take(): Long =
    val first = events(0)
    size -= 1
    val time   = times(size)
    val number = sequence(size)
    var hole   = 0
    var child  = 1
    while child < size do
      if child + 1 < size && isBefore(times(child + 1), sequence(child + 1), child) then child += 1
      if isBefore(time, number, child) then child = size
      else
        move(child, hole)
        hole = child
        child = 2 * hole + 1
    put(hole, time, number, events(size))
    first

  private def isBefore(time: Long, number: Long, other: Int): Boolean =
    time < times(other) || (time == times(other) && number < sequence(other))

  private def move(from: Int, to: Int): Unit = put(to, times(from), sequence(from), events(from))

  private def put(at: Int, time: Long, number: Long, event: Long): Unit =
    times(at) = time; sequence(at) = number; events(at) = event

private[skein] object EventQueue:
  private val Room = 16

  /** Added to an event's sequence number, which places it after all others of its time. */
  private val Last = 1L << 62
