package skein.link

import org.apache.pekko.util.ByteString
import skein.signal.{PacketLoss, SplitMix64}
import skein.units.Span

/** What happens to the packets of one direction of one connection. */
private[link] enum Packets:
  /** None is lost, so a stream of bytes need not be cut into packets. */
  case Whole

  /** Each piece is a datagram, which may be lost, and may come twice. */
  case Datagrams(loss: PacketLoss, duplicates: Double, random: SplitMix64)

  /** TCP's: a lost one is sent again after a time-out, which doubles each time, or sooner if a later packet
    * passes: once its acknowledgement is back, but no earlier than an overtaken packet's might be (RFC 8985).
    *
    * @param timeout the first ([[skein.signal.Retransmission.timeout]])
    * @param overtaken how long after its sending that is ([[skein.signal.Retransmission.overtaken]])
    */
  case Tcp(loss: PacketLoss, timeout: Span, overtaken: Span)

  def isDatagrams: Boolean = this match
    case _: Datagrams => true
    case _            => false

private[link] object Packets:
  /** Payload of a packet in an Ethernet frame, with the time stamps of TCP. */
  val Bytes = 1448

  /** Cuts bytes into packets of TCP. */
  def of(bytes: ByteString): Iterator[ByteString] =
    if bytes.size <= Bytes then Iterator.single(bytes) else bytes.grouped(Bytes)

/** Bytes on their way.
  *
  * @param due when they come out; [[Segment.Never]] while they are lost and not yet sent again
  */
private[link] final class Segment(val bytes: ByteString, var due: Span, sentAt: Span = Span.Zero):
  /** Of lost bytes: when they are sent again, and the wait after that. */
  var againAt: Span = Segment.Never
  var waits: Span   = Span.Zero

  /** Whether they were sent once. */
  var isFirst: Boolean = true

  /** When they count as lost by the acknowledgement of a later packet. */
  def missedAt(acknowledged: Span, overtaken: Span): Span = acknowledged.max(sentAt + overtaken)

  def isLost: Boolean = due == Segment.Never

private[link] object Segment:
  val Never: Span = Span.ofNanos(Long.MaxValue)

  /** Stands for bytes that never come out: the link broke. */
  val Gone: Span = Span.ofNanos(Long.MaxValue - 1)
