package skein.link

import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicInteger
import scala.jdk.CollectionConverters.*
import skein.units.*

/** Allocates a port's limited places. When all are taken, a new guest gets the place of the earliest guest
  * that has not yet sent a message of the port's protocol; else of the one that has been silent for the
  * longest time, if that is at least `silence`; else it is refused. So a guest that only holds a place is
  * removed immediately when a new guest needs it. Safe from any thread.
  */
private[skein] class Places(most: Int, silence: Span):
  private val guests = ConcurrentHashMap[Long, Places.Guest]()
  private val taken  = AtomicInteger()

  /** Admits one more guest if there is a place, which the guest keeps until it has [[left]]; returns whether
    * it is admitted.
    */
  def admit(): Boolean = synchronized:
    val free = taken.incrementAndGet() <= most || vacate()
    if !free then
      val _ = taken.decrementAndGet()
    free

  /** @param number counts guests in the order of arrival */
  def entered(number: Long, guest: Places.Guest): Unit =
    val _ = guests.put(number, guest)

  def left(number: Long): Unit =
    val _ = guests.remove(number)
    val _ = taken.decrementAndGet()

  private def vacate(): Boolean =
    val present = guests.asScala
    val leaving = present
      .filter(!_._2.hasSpoken)
      .minByOption(_._1)
      .orElse(present.maxByOption(_._2.silentFor).filter(_._2.silentFor >= silence))
    for (number, guest) <- leaving do
      val _ = guests.remove(number)
      guest.leave()
    leaving.isDefined

private[skein] object Places:
  /** A holder of a place; called from any thread. */
  trait Guest:
    /** Whether the guest has sent a message of the port's protocol. */
    def hasSpoken: Boolean

    /** Time since the guest last sent a request or waited for an answer. */
    def silentFor: Span

    /** Closes the guest's connection: another guest gets its place. */
    def leave(): Unit
