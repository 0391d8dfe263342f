package skein.rpc

import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicInteger
import scala.jdk.CollectionConverters.*
import skein.units.*

/** Who has one of a server's limited places. When all are taken, the connection that has been silent for the
  * longest time gives up its own, so that connections nobody uses do not lock others out. [[admit]] by one
  * thread at a time.
  */
private[rpc] class ConnectionSlots(most: Int, silence: Span):
  private val guests = ConcurrentHashMap[Long, ConnectionSlots.Guest]()
  private val taken  = AtomicInteger()

  /** Whether one more may come; it has a place then, until it has [[left]]. */
  def admit(): Boolean =
    val free = taken.incrementAndGet() <= most || vacate()
    if !free then
      val _ = taken.decrementAndGet()
    free

  def entered(connection: Long, guest: ConnectionSlots.Guest): Unit =
    val _ = guests.put(connection, guest)

  def left(connection: Long): Unit =
    val _ = guests.remove(connection)
    val _ = taken.decrementAndGet()

  private def vacate(): Boolean =
    guests.asScala.maxByOption(_._2.silentFor) match
      case Some((connection, guest)) if guest.silentFor >= silence =>
        val _ = guests.remove(connection)
        guest.leave()
        true
      case _ => false

private[rpc] object ConnectionSlots:
  trait Guest:
    /** For how long it has asked nothing and waited for nothing. */
    def silentFor: Span

    /** It is to close. From any thread. */
    def leave(): Unit
