package skein.view

import java.util.concurrent.atomic.AtomicLong

/** What a server has turned away. */
final class RefusalCounts:
  private val connections, requests, messages = AtomicLong()

  private[view] def refusedConnection(): Unit = connections.incrementAndGet(): Unit
  private[view] def refusedRequest(): Unit    = requests.incrementAndGet(): Unit
  private[view] def refusedMessage(): Unit    = messages.incrementAndGet(): Unit

  /** Connections beyond the most that may be open. */
  def refusedConnections: Long = connections.get

  /** Requests of foreign pages, for what is not there, or for what may not be done. */
  def refusedRequests: Long = requests.get

  /** Messages of viewers that were none of the protocol. */
  def refusedMessages: Long = messages.get
