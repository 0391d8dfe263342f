package skein.rpc

import scala.concurrent.Future
import skein.link.Address
import upack.Msg

/** One request as a handler sees it.
  *
  * @param connection which connection it came on; counts from 1 in the order they were accepted
  * @param notification whether the sender wants no answer
  */
final case class RpcRequest(connection: Long, method: String, params: IndexedSeq[Msg], notification: Boolean)

/** What happens at a server besides answers. */
enum ServerEvent:
  case Opened(connection: Long, from: Address)

  /** The peer sends no more, and may have left: what it has asked for is still answered. */
  case Finished(connection: Long)

  /** The connection ended; `reason` is None if the peer closed it between two messages. */
  case Closed(connection: Long, reason: Option[String])

  /** One connection too many. */
  case TurnedAway(from: Address)

  /** A value that is no message; dropped. */
  case Ignored(connection: Long, what: String)

/** Answers one request: `Left` is the text of the reply's error slot, `Right` the result. Replies leave in
  * the order in which the futures complete. It must not block.
  */
type RpcHandler = RpcRequest => Future[Either[String, Msg | Encoded]]
