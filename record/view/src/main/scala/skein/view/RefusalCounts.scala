package skein.view

import java.util.concurrent.atomic.AtomicLong
import skein.link.Seats

/** What a server has turned away. */
final class RefusalCounts private[view] (seats: Seats):
  private val requests, messages = AtomicLong()

  private[view] def refusedRequest(): Unit = requests.incrementAndGet(): Unit
  private[view] def refusedMessage(): Unit = messages.incrementAndGet(): Unit

  /** Connections beyond the most that may be open. */
  def refusedConnections: Long = seats.refusedConnections

  /** Connections that said nothing, and were closed to make room for others. */
  def displacedConnections: Long = seats.displacedConnections

  /** Requests of foreign pages, for what is not there, or for what may not be done. */
  def refusedRequests: Long = requests.get

  /** Messages of viewers that were none of the protocol. */
  def refusedMessages: Long = messages.get
