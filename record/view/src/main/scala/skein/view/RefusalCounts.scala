package skein.view

import java.util.concurrent.atomic.AtomicLong
import skein.link.Seats

/** Counts of a server's refused connections and requests. */
final class RefusalCounts private[view] (seats: Seats):
  private val requests, messages = AtomicLong()

  private[view] def refusedRequest(): Unit = requests.incrementAndGet(): Unit
  private[view] def refusedMessage(): Unit = messages.incrementAndGet(): Unit

  /** Connections refused because too many were open. */
  def refusedConnections: Long = seats.refusedConnections

  /** Number of silent connections that were closed to make room for new ones. */
  def displacedConnections: Long = seats.displacedConnections

  /** Requests of foreign pages, for missing resources, or for forbidden actions. */
  def refusedRequests: Long = requests.get

  /** Viewers' messages that do not belong to the protocol. */
  def refusedMessages: Long = messages.get
