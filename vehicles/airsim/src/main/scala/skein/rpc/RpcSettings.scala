package skein.rpc

import scala.concurrent.Future
import skein.units.*

/** The set of connections that a call uses. Each channel has its own, so a large reply never delays a small
  * one.
  */
enum Channel:
  /** Small and urgent messages: readings and commands. */
  case Control

  /** Small and periodic messages: sensor readings. */
  case Sensors

  /** Large messages that may wait: images, point clouds. */
  case Bulk

/** What happens to a call when the window is full. */
enum WhenFull:
  /** The call fails immediately with [[RpcError.Overloaded]]. */
  case Refuse

  /** The call waits in the channel's bounded queue; if the queue is also full, the call fails with
    * [[RpcError.Overloaded]].
    */
  case Wait

/** Options of one call.
  *
  * @param timeout time from the call to its answer, waiting included; then [[RpcError.Timeout]]
  * @param idempotent whether the call may run twice without harm: then it is sent again, a bounded number of
  *   times, when its connection is lost
  * @param key calls with equal keys use one connection and are sent in the order of the calls
  * @param withdrawn when it completes, the answer is no longer awaited: [[RpcError.Timeout]] before the
  *   timeout has elapsed
  */
final case class CallOptions(
    timeout: Span = Span.ofSeconds(5),
    channel: Channel = Channel.Control,
    idempotent: Boolean = false,
    key: Option[Int] = None,
    whenFull: WhenFull = WhenFull.Refuse,
    withdrawn: Option[Future[?]] = None
)

/** The bounds of a client. Windows and queue apply to each channel separately.
  *
  * @param controlConnections number of connections of [[Channel.Control]], opened with its first call; the
  *   paper's pool has 5
  * @param sensorConnections number of connections of [[Channel.Sensors]], opened with its first call
  * @param bulkConnections number of connections of [[Channel.Bulk]], opened with its first call
  * @param windowPerConnection maximum number of calls sent and not yet ended on one connection
  * @param windowInAll maximum number of calls sent and not yet ended on all connections of a channel
  * @param queue maximum number of a channel's calls that wait for room in a window or for a connection being
  *   opened
  * @param resends maximum number of times that one idempotent call is sent again
  * @param rememberedIds number of timed-out calls that a connection remembers, to recognise their late
  *   replies
  * @param strays maximum number of values on a connection, since the last expected reply, that answer no call
  *   of ours; then it is closed as malformed
  * @param messageTime maximum time from a message's first byte to its last, after which its connection is
  *   closed as malformed
  * @param openBytes maximum number of bytes of unfinished messages on all connections together, beyond 1 MiB
  *   on each; a connection whose message finds no room is closed as malformed
  * @param limits limits for one message on [[Channel.Control]] and [[Channel.Sensors]]
  * @param bulkLimits limits for one message on [[Channel.Bulk]]
  */
final case class RpcSettings(
    controlConnections: Int = 5,
    sensorConnections: Int = 1,
    bulkConnections: Int = 1,
    windowPerConnection: Int = 64,
    windowInAll: Int = 256,
    queue: Int = 256,
    resends: Int = 2,
    rememberedIds: Int = 4096,
    strays: Int = 1000,
    messageTime: Span = Span.ofSeconds(60),
    openBytes: Long = 128 << 20,
    backOff: BackOff = BackOff(),
    limits: FrameLimits = FrameLimits(frameBytes = 4 << 20, elements = 1 << 18, maps = 1 << 16),
    bulkLimits: FrameLimits = FrameLimits()
):
  require(
    controlConnections > 0 && sensorConnections > 0 && bulkConnections > 0 &&
      windowPerConnection > 0 && windowInAll > 0 && queue >= 0 &&
      resends >= 0 && rememberedIds >= 0 && strays >= 0 && messageTime > Span.Zero && openBytes >= 0,
    s"connections and windows must be positive, the other bounds not negative: $this"
  )

  private[rpc] def newHoldings(): Holdings = Holdings(each = 1 << 20, common = openBytes)

  def limits(channel: Channel): FrameLimits = if channel == Channel.Bulk then bulkLimits else limits

  def connections(channel: Channel): Int = channel match
    case Channel.Control => controlConnections
    case Channel.Sensors => sensorConnections
    case Channel.Bulk    => bulkConnections

/** Pauses between attempts to connect: doubling from `first` to at most `longest`, each shortened at random
  * by up to the fraction `jitter`, so that clients do not return in step.
  */
final case class BackOff(
    first: Span = Span.ofMillis(50),
    longest: Span = Span.ofSeconds(2),
    jitter: Double = 0.5
):
  require(first > Span.Zero && longest >= first && jitter >= 0 && jitter <= 1, s"not a back-off: $this")

  /** The pause after the given number of failures in a row (at least 1); `uniform` in [0, 1). */
  def pause(failures: Int, uniform: Double): Span =
    val doubled = first.toNanos * StrictMath.pow(2, math.min(failures - 1, 40))
    Span.ofNanos((math.min(doubled, longest.toNanos.toDouble) * (1 - jitter * uniform)).toLong)
