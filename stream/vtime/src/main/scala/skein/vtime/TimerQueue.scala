package skein.vtime

import java.util.PriorityQueue

/** A task to run at a time; at equal times, tasks run in the order in which they were scheduled. */
private final class Timer(val dueNanos: Long, val sequence: Long, val task: Runnable)
    extends Comparable[Timer]:
  var cancelled: Boolean = false

  def compareTo(other: Timer): Int =
    val byTime = java.lang.Long.compare(dueNanos, other.dueNanos)
    if byTime != 0 then byTime else java.lang.Long.compare(sequence, other.sequence)

/** Timers by time and sequence. A cancelled timer stays until it is due or until half of the queue is
  * cancelled, so that cancelling costs nothing and yet the queue holds at most twice the active timers, plus
  * [[TimerQueue.slack]].
  */
private final class TimerQueue:
  private val heap      = PriorityQueue[Timer]()
  private var cancelled = 0
  private var sequence  = 0L

  def add(dueNanos: Long, task: Runnable): Timer =
    val timer = Timer(dueNanos, sequence, task)
    sequence += 1
    heap.add(timer): Unit
    timer

  def cancel(timer: Timer): Unit =
    timer.cancelled = true
    cancelled += 1
    if cancelled > TimerQueue.slack && cancelled > heap.size / 2 then
      heap.removeIf(_.cancelled): Unit
      cancelled = 0

  /** The earliest timer that is not cancelled, still in the queue. */
  def head: Option[Timer] =
    while !heap.isEmpty && heap.peek.cancelled do
      heap.poll(): Unit
      cancelled -= 1
    Option(heap.peek)

  /** Removes the timer that [[head]] returned. */
  def removeHead(): Unit = heap.poll(): Unit

  /** Empties the queue; returns the active timers in order. */
  def removeAll(): Seq[Timer] =
    val all = Seq.unfold(this)(_.head.map: timer =>
      removeHead()
      (timer, this))
    cancelled = 0
    all

  def size: Int = heap.size

private object TimerQueue:
  val slack = 1024
