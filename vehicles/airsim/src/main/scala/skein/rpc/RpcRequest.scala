package skein.rpc

import scala.concurrent.Future
import skein.link.Address
import upack.Msg

/** One request, as a handler receives it.
  *
  * @param connection counts from 1 in the order of acceptance
  * @param notification whether the sender expects no answer
  */
final case class RpcRequest(connection: Long, method: String, params: IndexedSeq[Msg], notification: Boolean)

/** Events of a server other than answers. */
enum ServerEvent:
  case Opened(connection: Long, from: Address)

  /** The peer sends no more, and may have left; its requests are still answered. */
  case Finished(connection: Long)

  /** The connection ended; `reason` is None if the peer closed it between two messages. */
  case Closed(connection: Long, reason: Option[String])

  /** A connection was refused: the limit of connections is reached. */
  case TurnedAway(from: Address)

  case Ignored(connection: Long, what: String)

/** Answers one request: `Left` is the text of the reply's error slot, `Right` the result. Replies leave in
  * the order in which the futures complete. It must not block.
  */
type RpcHandler = RpcRequest => Future[Either[String, Msg | Encoded]]
