package skein.link

import skein.signal.Bandwidth
import skein.units.*

/** One direction of a line that all connections of a link share: it transmits its queue, first in, first out,
  * at its rate. Nothing is dropped. A connection with more to send than the queue accepts keeps the rest at
  * its sender, and hands over piece by piece as there is room, in turn with other connections. So data on
  * another connection waits for at most a full queue and a piece of every waiting connection; data on one
  * connection waits for everything sent before on it, as behind the head of one TCP connection.
  *
  * Times count from the link's start. Any thread.
  */
private[link] final class Bottleneck(bandwidth: Bandwidth):
  import Bottleneck.*
  private val queueTime = bandwidth.timeOf(bandwidth.queueBytes)
  private var freeAt    = Span.Zero

  /** Maximum number of bytes that a connection hands over in one piece: an eighth of the queue, and at least
    * an Ethernet frame.
    */
  val pieceBytes: Int = (bandwidth.queueBytes / 8).max(FrameBytes)

  /** The time at which the line will have transmitted everything handed over so far. */
  def free(now: Span): Span = synchronized(freeAt.max(now))

  /** Takes a piece.
    *
    * @return when the line will have transmitted it, and when the queue has room for another piece of that
    *   connection
    */
  def send(now: Span, bytes: Int): (sentAt: Span, roomAt: Span) = synchronized:
    freeAt = freeAt.max(now) + bandwidth.timeOf(bytes)
    (sentAt = freeAt, roomAt = now.max(freeAt - queueTime))

private object Bottleneck:
  private val FrameBytes = 1500
