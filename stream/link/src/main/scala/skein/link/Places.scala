package skein.link

import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicInteger
import scala.jdk.CollectionConverters.*
import skein.units.*

/** Who has one of a port's limited places. When all are taken, one more gets the place of the guest that came
  * first of those who have said nothing of the port's protocol yet; else of the one that has been silent for
  * the longest time, if that is at least `silence`; else it is turned away. So whoever only holds a place
  * makes room at once for those who speak. Safe from any thread.
  */
private[skein] class Places(most: Int, silence: Span):
  private val guests = ConcurrentHashMap[Long, Places.Guest]()
  private val taken  = AtomicInteger()

  /** Whether one more may come; it has a place then, until it has [[left]]. */
  def admit(): Boolean = synchronized:
    val free = taken.incrementAndGet() <= most || vacate()
    if !free then
      val _ = taken.decrementAndGet()
    free

  /** @param number counts guests in the order in which they come
    */
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
  /** Asked from any thread. */
  trait Guest:
    /** Whether a message of the port's protocol has come of it. */
    def hasSpoken: Boolean

    /** For how long it has asked nothing and waited for nothing. */
    def silentFor: Span

    /** It is to close. */
    def leave(): Unit
