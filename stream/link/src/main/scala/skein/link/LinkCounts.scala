package skein.link

import java.util.concurrent.atomic.{LongAccumulator, LongAdder}
import skein.units.*

/** Counts of a link since its start.
  *
  * @param connections number of connections opened over it
  * @param bytesToServer number of bytes delivered to the server
  * @param bytesToClient number of bytes delivered to the client
  * @param bytesLost number of bytes lost in a silence, or in transit when the link broke
  * @param stalls number of stalls; a stall counts once for each direction of each connection that it held up
  * @param disconnects number of connections that the link broke
  * @param bytesHeldBack number of bytes that waited at their senders because the queue of a line with a rate
  *   was full
  * @param longestWait longest wait of any bytes, from their sending until a line with a rate had sent them
  * @param packetsLost number of datagrams that the profile lost, or TCP's packets, repeated ones included
  * @param packetsSentAgain number of packets that TCP sent again because they were lost
  * @param duplicates number of duplicated datagrams
  */
final case class LinkCounts(
    connections: Long,
    bytesToServer: Long,
    bytesToClient: Long,
    bytesLost: Long,
    stalls: Long,
    disconnects: Long,
    bytesHeldBack: Long,
    longestWait: Span,
    packetsLost: Long,
    packetsSentAgain: Long,
    duplicates: Long
)

/** The counters that a link's lines share. */
private[link] final class LinkCounters:
  val bytesLost, stalls, disconnects, bytesHeldBack, packetsLost, packetsSentAgain, duplicates = LongAdder()
  val longestWaitNs = LongAccumulator(math.max(_, _), 0)
