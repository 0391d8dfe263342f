package skein.rpc

import java.util.concurrent.atomic.{AtomicLong, LongAdder}

/** Counts of a server since it was bound.
  *
  * @param connections number of open connections
  * @param accepted number of connections served, closed ones included
  * @param turnedAway number of connections beyond the limit
  * @param closedWithReason number of connections that ended because of malformed input, a cut message, a
  *   limit or a failure
  * @param malformed number of connections among `closedWithReason` that sent a value that is not a message,
  *   or exceeds [[FrameLimits]]
  * @param overHeld number of connections among `closedWithReason` that reached the memory limit
  * @param tooSlow number of connections among `closedWithReason` that took too long for a message, or to take
  *   replies
  * @param idle number of connections among `closedWithReason` that were silent when their place was needed,
  *   or for [[ServerLimits.idle]]
  * @param answered number of replies with a result
  * @param refused number of replies with an error
  * @param lacking number of requests, replies and dropped notifications that were too large for the memory
  *   left
  * @param ignored number of values that were not messages
  * @param dropped number of accepted requests that were not run because their connection closed before their
  *   turn
  * @param heldBytes number of bytes held for peers now; see [[ServerLimits.heldBytes]]
  * @param mostHeldBytes the maximum of `heldBytes`
  */
final case class ServerStats(
    connections: Long,
    accepted: Long,
    turnedAway: Long,
    closedWithReason: Long,
    malformed: Long,
    overHeld: Long,
    tooSlow: Long,
    idle: Long,
    requests: Long,
    notifications: Long,
    answered: Long,
    refused: Long,
    lacking: Long,
    ignored: Long,
    dropped: Long,
    heldBytes: Long,
    mostHeldBytes: Long
)

/** The kind of limit for which a server closes a connection. */
private[rpc] enum ServerLimit:
  case Malformed, Held, Time, Idle

private[rpc] final class ServerCounters(holdings: Holdings):
  val requests, notifications, answered, refused, lacking         = LongAdder()
  private val malformed, overHeld, tooSlow, idle                  = LongAdder()
  private val closed, closedWithReason, turnedAway, ignoredValues = LongAdder()
  private val accepted                                            = AtomicLong()

  /** Returns the number of a newly accepted connection. */
  def nextConnection(): Long = accepted.incrementAndGet()

  def open: Long = accepted.get - closed.sum

  def limited(limit: ServerLimit): Unit = (limit match
    case ServerLimit.Malformed => malformed
    case ServerLimit.Held      => overHeld
    case ServerLimit.Time      => tooSlow
    case ServerLimit.Idle      => idle
  ).increment()

  def count(event: ServerEvent): Unit = event match
    case ServerEvent.Opened(_, _)      => ()
    case ServerEvent.Finished(_)       => ()
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
    malformed.sum,
    overHeld.sum,
    tooSlow.sum,
    idle.sum,
    requests.sum,
    notifications.sum,
    answered.sum,
    refused.sum,
    lacking.sum,
    ignoredValues.sum,
    dropped = 0,
    holdings.bytes,
    holdings.mostBytes
  )
