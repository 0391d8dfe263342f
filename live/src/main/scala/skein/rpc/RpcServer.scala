package skein.rpc

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.KillSwitches
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future}
import skein.link.{Address, Incoming, Listening, Transport}
import upack.Msg

/** One request as a handler sees it.
  *
  * @param connection
  *   which connection it came on; counts from 1 in the order they were accepted
  * @param notification
  *   whether the sender wants no answer
  */
final case class RpcRequest(connection: Long, method: String, params: IndexedSeq[Msg], notification: Boolean)

/** What one server gives its peers.
  *
  * @param inFlightPerConnection
  *   most requests of one connection being handled; beyond that its socket is not read
  * @param unsentBytesPerConnection
  *   a connection that has this many bytes of replies to take is not read until it has taken them
  * @param connections
  *   most connections open; further ones are closed as they come
  */
final case class ServerLimits(
    frame: FrameLimits = FrameLimits(),
    inFlightPerConnection: Int = 256,
    unsentBytesPerConnection: Int = 1 << 20,
    connections: Int = 256
):
  require(
    inFlightPerConnection > 0 && unsentBytesPerConnection > 0 && connections > 0,
    s"limits must be positive: $this"
  )

/** What happens at a server besides answers. */
enum ServerEvent:
  case Opened(connection: Long, from: Address)

  /** The connection ended; `reason` is None if the peer closed it between two messages. */
  case Closed(connection: Long, reason: Option[String])

  /** One connection too many. */
  case TurnedAway(from: Address)

  /** A value that is no message; dropped. */
  case Ignored(connection: Long, what: String)

/** A running MessagePack-RPC server. */
final class RpcServer private (
    listening: Listening,
    counters: ServerCounters,
    stop: () => Unit
):
  /** Where it listens, with the actual port. */
  def address: Address = listening.address

  def stats: ServerStats = counters.snapshot

  /** Accepts no more and closes every connection; requests being handled get no answer. */
  def close(): Future[Done] =
    val unbound = listening.close()
    stop()
    unbound

object RpcServer:

  /** Answers one request: `Left` is the text of the reply's error slot, `Right` the result. Replies leave in the order
    * in which the futures complete. It must not block.
    */
  type Handler = RpcRequest => Future[Either[String, Msg]]

  /** Serves `handler` at `at`; the future fails if that cannot be bound. Malformed input closes its own connection,
    * with a reason that is logged, counted and observed, and harms no other.
    *
    * @param failureText
    *   the error text for a request whose handler throws or fails
    * @param observer
    *   told of every event, on the connections' threads; it must be quick and throw nothing
    */
  def bind(
      transport: Transport,
      at: Address,
      limits: ServerLimits = ServerLimits(),
      failureText: (RpcRequest, Throwable) => String = rpclibFailure,
      observer: ServerEvent => Unit = _ => ()
  )(handler: Handler)(using system: ActorSystem): Future[RpcServer] =
    val counters = ServerCounters()
    val stop     = KillSwitches.shared("rpc-server")

    def observe(event: ServerEvent): Unit =
      event match
        case ServerEvent.Closed(connection, Some(reason)) =>
          system.log.warning("RPC connection {} closed: {}", connection, reason)
        case ServerEvent.TurnedAway(from) =>
          system.log.warning("RPC connection from {} refused: {} are open", from, limits.connections)
        case _ => ()
      counters.count(event)
      observer(event)

    def accept(incoming: Incoming): Unit =
      if counters.open >= limits.connections then
        observe(ServerEvent.TurnedAway(incoming.from))
        val _ = Source.empty[ByteString].via(incoming.flow).runWith(Sink.cancelled)
      else
        val connection = counters.nextConnection()
        observe(ServerEvent.Opened(connection, incoming.from))
        val stage = ServerConnection(connection, limits, handler, failureText, counters, observe)
        val _     = incoming.flow.join(Flow.fromGraph(stage).via(stop.flow)).run()

    val (listening, ended) = transport.listen(at).toMat(Sink.foreach(accept))(Keep.both).run()
    ended.failed.foreach(failure => system.log.debug("RPC server at {} ended: {}", at, failure))(using
      ExecutionContext.parasitic
    )
    listening.map(RpcServer(_, counters, () => stop.shutdown()))(using ExecutionContext.parasitic)

  /** The words of AirSim's server for a function that throws. */
  def rpclibFailure(request: RpcRequest, failure: Throwable): String =
    val text = Option(failure.getMessage).getOrElse(failure.toString)
    s"rpclib: function '${request.method}' (called with ${request.params.length} arg(s)) threw an exception. " +
      s"The exception contained this information: $text."
