package skein.rpc

import skein.units.*

/** What happens to a client besides answers, for whoever records or watches it. Connections count from 0 in
  * each channel.
  */
enum RpcEvent:
  case Connected(channel: Channel, connection: Int)

  /** An open connection ended. */
  case Disconnected(channel: Channel, connection: Int, reason: String)

  /** A connection could not be opened. */
  case ConnectFailed(channel: Channel, connection: Int, reason: String)

  /** The next attempt follows after `pause`. */
  case Reconnecting(channel: Channel, connection: Int, pause: Span)

  /** A call ended without a result. */
  case Failed(method: String, channel: Channel, error: RpcError)

  /** An idempotent call goes out again after its connection was lost. */
  case SentAgain(method: String, channel: Channel)

  /** An answer to a call that had timed out, `after` its sending; dropped. */
  case LateReply(method: String, channel: Channel, connection: Int, after: Span)

  /** An answer to no known call; dropped. */
  case UnexpectedReply(id: Long, channel: Channel, connection: Int)

  /** A value that is no reply; dropped. */
  case Ignored(what: String, channel: Channel, connection: Int)

  /** A flow passed over an element whose call failed. */
  case Skipped(method: String, error: RpcError)
