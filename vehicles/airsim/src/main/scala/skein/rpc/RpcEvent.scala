package skein.rpc

import skein.units.*

/** Events of a client other than answers, for recording and observing. Connections count from 0 in each
  * channel.
  */
enum RpcEvent:
  case Connected(channel: Channel, connection: Int)

  case Disconnected(channel: Channel, connection: Int, reason: String)

  case ConnectFailed(channel: Channel, connection: Int, reason: String)

  case Reconnecting(channel: Channel, connection: Int, pause: Span)

  case Failed(method: String, channel: Channel, error: RpcError)

  /** An idempotent call is sent again after its connection was lost. */
  case SentAgain(method: String, channel: Channel)

  /** An answer to a call that had timed out was received `after` the call was sent, and dropped. */
  case LateReply(method: String, channel: Channel, connection: Int, after: Span)

  case UnexpectedReply(id: Long, channel: Channel, connection: Int)

  /** A value that is not a reply was received and dropped. */
  case Ignored(what: String, channel: Channel, connection: Int)
