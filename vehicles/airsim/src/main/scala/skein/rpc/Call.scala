package skein.rpc

import scala.concurrent.Promise
import skein.units.*
import upack.Msg

/** A result with the times from which its age is computed, on the client's clock.
  *
  * @param sentAt when the request was handed to the transport (the last time, if it was sent again)
  * @param receivedAt when the reply's last byte was received
  */
final case class TimedReply[+A](value: A, sentAt: Instant, receivedAt: Instant):
  def map[B](f: A => B): TimedReply[B] = copy(value = f(value))

  def roundTrip: Span = receivedAt.since(sentAt)

/** One call in progress through a channel. Only the channel's thread changes it. */
private[rpc] final class Call(
    val method: String,
    val params: Seq[Msg],
    val options: CallOptions,
    val calledAt: Instant
):
  val outcome: Promise[Either[RpcError, TimedReply[Msg | Received]]] = Promise()
  val deadline: Instant                                              = calledAt + options.timeout

  var sequence: Long = -1

  var connection: Int = -1
  var id: Long        = -1

  /** Whether the call's bytes were handed to the transport of the current connection. */
  var written: Boolean = false
  var sends: Int       = 0
  var sentAt: Instant  = Instant.Epoch
  var ended: Boolean   = false
