package skein.rpc

import java.util.concurrent.atomic.{AtomicLong, LongAdder}

/** Counts of a server since it was bound.
  *
  * @param connections open now
  * @param accepted connections served, closed ones included
  * @param turnedAway connections beyond the limit
  * @param closedWithReason connections that ended because of malformed input, a cut message, a limit or a
  *   failure
  * @param malformed connections among `closedWithReason` that sent a value that is no message, or exceeds
  *   [[FrameLimits]]
  * @param overHeld connections among `closedWithReason` that reached the memory limit
  * @param tooSlow connections among `closedWithReason` that took too long for a message, or to take replies
  * @param idle connections among `closedWithReason` that were silent when their place was needed, or for
  *   [[ServerLimits.idle]]
  * @param answered replies with a result
  * @param refused replies with an error
  * @param lacking requests, replies and dropped notifications that were too large for the memory left
  * @param ignored values that were no messages
  * @param dropped requests taken and not run, because their connection had closed before their turn
  * @param heldBytes bytes held for peers now; see [[ServerLimits.heldBytes]]
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
