package skein.rpc

import java.util.concurrent.atomic.{AtomicLong, LongAdder}

/** What a server has counted since it was bound.
  *
  * @param connections
  *   open now
  * @param accepted
  *   connections served, closed ones included
  * @param turnedAway
  *   connections beyond the limit
  * @param closedWithReason
  *   connections that ended because of malformed input, a cut message or a failure
  * @param answered
  *   replies with a result
  * @param refused
  *   replies with an error
  * @param ignored
  *   values that were no messages
  */
final case class ServerStats(
    connections: Long,
    accepted: Long,
    turnedAway: Long,
    closedWithReason: Long,
    requests: Long,
    notifications: Long,
    answered: Long,
    refused: Long,
    ignored: Long
)

private[rpc] final class ServerCounters:
  val requests, notifications, answered, refused                  = LongAdder()
  private val closed, closedWithReason, turnedAway, ignoredValues = LongAdder()
  private val accepted                                            = AtomicLong()

  /** The number of the connection now accepted. */
  def nextConnection(): Long = accepted.incrementAndGet()

  def open: Long = accepted.get - closed.sum

  def count(event: ServerEvent): Unit = event match
    case ServerEvent.Opened(_, _)      => ()
    case ServerEvent.Closed(_, reason) =>
      closed.increment()
      if reason.nonEmpty then closedWithReason.increment()
    case ServerEvent.TurnedAway(_) => turnedAway.increment()
    case ServerEvent.Ignored(_, _) => ignoredValues.increment()

  def snapshot: ServerStats = ServerStats(
    open,
    accepted.get,
    turnedAway.sum,
    closedWithReason.sum,
    requests.sum,
    notifications.sum,
    answered.sum,
    refused.sum,
    ignoredValues.sum
  )
