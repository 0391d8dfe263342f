package skein.rpc

import java.util.concurrent.atomic.LongAdder

/** Counts of a client since it was made. Every call ends exactly once:
  * `called = answered + refused + timedOut + lost + malformed + overloaded + cancelled + unreachable + pending`.
  *
  * @param sent number of requests written, including those sent again
  * @param late number of replies to calls that had timed out
  * @param unexpected number of replies to no known call
  * @param ignored number of values that were not replies
  */
final case class RpcStats(
    called: Long,
    sent: Long,
    answered: Long,
    refused: Long,
    timedOut: Long,
    lost: Long,
    malformed: Long,
    overloaded: Long,
    cancelled: Long,
    unreachable: Long,
    sentAgain: Long,
    late: Long,
    unexpected: Long,
    ignored: Long,
    connected: Long,
    disconnected: Long
):
  def pending: Long =
    called - answered - refused - timedOut - lost - malformed - overloaded - cancelled - unreachable

/** The counters behind [[RpcStats]]; written by all channels, read from any thread. */
private[rpc] final class RpcCounters:
  val called, sent, answered, refused, timedOut, lost, malformed, overloaded, cancelled, unreachable,
      sentAgain, late, unexpected, ignored, connected, disconnected = LongAdder()

  def failed(error: RpcError): Unit = (error match
    case _: RpcError.Timeout        => timedOut
    case _: RpcError.Refused        => refused
    case _: RpcError.ConnectionLost => lost
    case _: RpcError.Malformed      => malformed
    case _: RpcError.Overloaded     => overloaded
    case _: RpcError.Cancelled      => cancelled
    case _: RpcError.Unreachable    => unreachable
  ).increment()

  def snapshot: RpcStats = RpcStats(
    called.sum,
    sent.sum,
    answered.sum,
    refused.sum,
    timedOut.sum,
    lost.sum,
    malformed.sum,
    overloaded.sum,
    cancelled.sum,
    unreachable.sum,
    sentAgain.sum,
    late.sum,
    unexpected.sum,
    ignored.sum,
    connected.sum,
    disconnected.sum
  )
