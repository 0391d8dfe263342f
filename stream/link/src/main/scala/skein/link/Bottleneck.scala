package skein.link

import skein.signal.Bandwidth
import skein.units.*

/** One direction of a line that all connections of a link share: it sends at its rate what waits in one
  * queue, first in, first out. Nothing is dropped. A connection with more to send than the queue takes keeps
  * the rest at its sender, and hands over one piece after another as there is room, in turns with the others.
  * So what is sent on another connection waits for at most a full queue and a piece of every connection that
  * waits; what is sent on the same one waits for all that was sent on it before, as behind the head of one
  * TCP connection.
  *
  * Times count from the link's start. Any thread.
  */
private[link] final class Bottleneck(bandwidth: Bandwidth):
  import Bottleneck.*
  private val queueTime = bandwidth.timeOf(bandwidth.queueBytes)
  private var freeAt    = Span.Zero

  /** Most bytes that a connection hands over at once: an eighth of the queue, and an Ethernet frame at least.
    */
  val pieceBytes: Int = (bandwidth.queueBytes / 8).max(FrameBytes)

  /** When the line has sent all that it was handed until now. */
  def free(now: Span): Span = synchronized(freeAt.max(now))

  /** Takes a piece.
    *
    * @return when the line will have sent it, and when the queue has room for another piece of the same
    *   connection
    */
  def send(now: Span, bytes: Int): (sentAt: Span, roomAt: Span) = synchronized:
    freeAt = freeAt.max(now) + bandwidth.timeOf(bytes)
    (sentAt = freeAt, roomAt = now.max(freeAt - queueTime))

private object Bottleneck:
  private val FrameBytes = 1500
