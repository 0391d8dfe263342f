package skein.link

import java.util.concurrent.atomic.{LongAccumulator, LongAdder}
import skein.units.*

/** What a link has done so far.
  *
  * @param connections opened over it
  * @param bytesToServer that came out at the server's side
  * @param bytesToClient that came out at the client's side
  * @param bytesLost swallowed by a silence, or under way when the link broke
  * @param stalls a stall counts once for each direction of each connection that it held up
  * @param disconnects connections that the link broke
  * @param bytesHeldBack that waited at their senders, because the queue of a line with a rate was full
  * @param longestWait of any bytes, from their sending until a line with a rate had sent them
  */
final case class LinkCounts(
    connections: Long,
    bytesToServer: Long,
    bytesToClient: Long,
    bytesLost: Long,
    stalls: Long,
    disconnects: Long,
    bytesHeldBack: Long,
    longestWait: Span
)

/** Where the lines of a link count. */
private[link] final class LineCounters(
    val bytesDelivered: LongAdder,
    val bytesLost: LongAdder,
    val bytesHeldBack: LongAdder,
    val longestWaitNs: LongAccumulator,
    val onBreak: () => Unit
)
