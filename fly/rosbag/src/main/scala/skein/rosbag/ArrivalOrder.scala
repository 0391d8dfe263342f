package skein.rosbag

import scala.collection.mutable
import skein.units.Instant

/** Handles messages in the order of their arrival, although middleware delivers them topic by topic. Mutable.
  * Keeps at most [[ArrivalOrder.MostHeld]] messages; beyond that, the earliest is handled early.
  */
private[rosbag] final class ArrivalOrder:
  import ArrivalOrder.*

  private val earliest = Ordering.by[Held, (Instant, Long)](_.order).reverse
  private val held     = mutable.PriorityQueue.empty[Held](using earliest)
  private var number   = 0L

  def add(at: Instant)(handle: => Unit): Unit =
    held.enqueue(Held((at, number), () => handle))
    number += 1
    if held.size > MostHeld then held.dequeue().handle()

  /** Handles every message that had arrived by `at`. */
  def upTo(at: Instant): Unit = while held.nonEmpty && held.head.order._1 <= at do held.dequeue().handle()

private object ArrivalOrder:
  val MostHeld = 16_384

  final case class Held(order: (Instant, Long), handle: () => Unit)
