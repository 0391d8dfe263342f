package skein.link

import org.apache.pekko.util.ByteString
import skein.signal.{PacketLoss, Retransmission, SplitMix64}
import skein.units.Span

/** The losses, repetitions and duplicates of the packets in one direction of one connection. */
private[link] enum Packets:
  /** No packet is lost, so a stream of bytes need not be cut into packets. */
  case Whole

  /** Each piece is a datagram, which may be lost, and may arrive twice. */
  case Datagrams(loss: PacketLoss, duplicates: Double, random: SplitMix64)

  /** TCP's packets. A lost packet is sent again after a timeout, which doubles each time. It is sent again
    * sooner once a later packet is acknowledged, but only when it can no longer be a merely overtaken packet
    * (RFC 8985).
    *
    * @param timeout the first time-out ([[skein.signal.Retransmission.timeout]])
    * @param overtaken time from its sending until it counts as lost and not as overtaken
    *   ([[skein.signal.Retransmission.overtaken]])
    */
  case Tcp(loss: PacketLoss, timeout: Span, overtaken: Span)

  def isDatagrams: Boolean = this match
    case _: Datagrams => true
    case _            => false

private[link] object Packets:
  /** Payload of a packet in an Ethernet frame, with the time stamps of TCP. */
  val Bytes = 1448

  def of(bytes: ByteString): Iterator[ByteString] =
    if bytes.size <= Bytes then Iterator.single(bytes) else bytes.grouped(Bytes)

/** Bytes in transit.
  *
  * @param due time at which they come out; [[Segment.Never]] while they are lost and not yet sent again
  */
private[link] final class Segment(val bytes: ByteString, var due: Span):
  private var sentAt   = Span.Zero
  private var timeout  = Span.Zero
  private var timedOut = false

  var againAt: Span = Segment.Never

  def isLost: Boolean = due == Segment.Never

  def lost(at: Span, by: Packets.Tcp): Unit =
    due = Segment.Never
    timeout = by.timeout
    waits(at)

  /** Loses the bytes again, when they are sent again. After a timeout TCP sends nothing else that would
    * reveal the loss.
    */
  def lostAgain(at: Span): Unit =
    if at >= sentAt + timeout then
      timedOut = true
      timeout = Retransmission.next(timeout)
    waits(at)

  private def waits(at: Span): Unit =
    sentAt = at
    againAt = at + timeout

  /** Handles an acknowledgement, at `acknowledged`, of a packet sent or sent again at `sent`: bytes lost
    * before then are sent again sooner.
    */
  def missed(sent: Span, acknowledged: Span, by: Packets.Tcp): Unit =
    if isLost && !timedOut && sentAt <= sent then
      againAt = againAt.min(acknowledged.max(sentAt + by.overtaken))

private[link] object Segment:
  val Never: Span = Span.ofNanos(Long.MaxValue)

  /** Stands for bytes that never come out: the link broke. */
  val Gone: Span = Span.ofNanos(Long.MaxValue - 1)
