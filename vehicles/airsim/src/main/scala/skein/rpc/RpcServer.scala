package skein.rpc

import java.util.concurrent.atomic.AtomicInteger
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.KillSwitches
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.control.NonFatal
import skein.link.{Address, Incoming, Listening, Places, Transport}

/** A running MessagePack-RPC server.
  *
  * @param failed completes if it stops listening without having been closed, with the reason; all its
  *   connections are closed then
  */
final class RpcServer private (
    listening: Listening,
    counters: ServerCounters,
    val failed: Future[Throwable],
    stop: () => Unit
):
  /** The listening address, with the actual port. */
  def address: Address = listening.address

  def stats: ServerStats = counters.snapshot

  /** Stops accepting and closes every connection; requests in progress get no answer. */
  def close(): Future[Done] =
    val unbound = listening.close()
    stop()
    unbound

object RpcServer:

  /** Serves `handler` at `at`; the future fails if that cannot be bound. Malformed input closes its own
    * connection, with a reason that is logged, counted and passed to the observer, and affects no other.
    *
    * @param observer called with every event on the connections' threads; it must be quick and throw nothing
    */
  def bind(
      transport: Transport,
      at: Address,
      limits: ServerLimits = ServerLimits(),
      observer: ServerEvent => Unit = _ => ()
  )(handler: RpcHandler)(using system: ActorSystem): Future[RpcServer] =
    val holdings = Holdings(limits.heldBytesPerConnection, limits.heldBytesInCommon)
    val turns    = Holdings(limits.inFlightAssured, limits.inFlightInCommon)
    val counters = ServerCounters(holdings)
    val places   = Places(limits.connections, limits.silence)
    val stop     = KillSwitches.shared("rpc-server")
    val told     = AtomicInteger()

    // Events that a hostile peer can cause without limit are logged a limited number of times, and then only
    // counted.
    def tell(what: => String): Unit =
      val before = told.getAndIncrement()
      if before < MostTold then system.log.warning("RPC {}", what)
      else if before == MostTold then system.log.warning("RPC: the like of it is only counted from now on")

    def observe(event: ServerEvent): Unit =
      event match
        case ServerEvent.Closed(connection, Some(reason)) => tell(s"connection $connection closed: $reason")
        case ServerEvent.TurnedAway(from)                 =>
          tell(s"connection from $from refused: ${limits.connections} are open")
        case _ => ()
      counters.count(event)
      observer(event)

    def serve(incoming: Incoming): Unit =
      val connection = counters.nextConnection()
      observe(ServerEvent.Opened(connection, incoming.from))
      val stage =
        ServerConnection(connection, limits, handler, counters, holdings, turns, places, observe)
      try
        val _ = incoming.flow.join(Flow.fromGraph(stage).via(stop.flow)).run()
      catch
        case NonFatal(failure) =>
          places.left(connection)
          observe(ServerEvent.Closed(connection, Some(s"it could not be served: $failure")))

    def accept(incoming: Incoming): Unit =
      if places.admit() then serve(incoming)
      else
        observe(ServerEvent.TurnedAway(incoming.from))
        val _ = Source.empty[ByteString].via(incoming.flow).runWith(Sink.cancelled)

    given ExecutionContext = ExecutionContext.parasitic
    val (listening, ended) = transport.listen(at).toMat(Sink.foreach(accept))(Keep.both).run()
    val failed             = Promise[Throwable]()
    for failure <- ended.failed do
      stop.shutdown()
      failed.success(failure)
    listening.map(RpcServer(_, counters, failed.future, () => stop.shutdown()))

  /** Maximum number of closed and refused connections that are logged one by one; later ones are only
    * counted.
    */
  private val MostTold = 20
