package skein.link

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{BidiFlow, Keep, Sink}
import org.apache.pekko.stream.{KillSwitches, SharedKillSwitch}
import scala.concurrent.{ExecutionContext, Future}

/** Puts an emulated link between clients and a server: it listens, and forwards each connection that it
  * accepts to the server's address, over the link in both directions. A client that gets through here while
  * the server does not listen sees its connection break.
  *
  * A connection is accepted without delay; only what crosses it is delayed. By datagrams, whoever is heard is
  * a connection.
  */
final class LinkProxy private (listening: Listening, link: EmulatedLink, switch: SharedKillSwitch):

  /** Where clients connect to, with the actual port. */
  def address: Address = listening.address

  def counts: LinkCounts = link.counts

  /** Accepts no more and closes the open connections. */
  def close(): Future[Done] =
    switch.shutdown()
    listening.close()

object LinkProxy:

  /** Starts listening. Fails with a [[TransportError]] where that is not possible.
    *
    * @param maxConnections open at the same time; further clients wait to be accepted
    * @param unreachable told why, when an accepted connection cannot be continued to the server
    * @param isDatagrams whether the transport carries datagrams: see [[EmulatedLink.connection]]
    */
  def start(
      listenAt: Address,
      to: Address,
      link: EmulatedLink,
      transport: Transport,
      maxConnections: Int = 1024,
      unreachable: Throwable => Unit = _ => (),
      isDatagrams: Boolean = false
  )(using ActorSystem): Future[LinkProxy] =
    given ExecutionContext = ExecutionContext.parasitic
    val switch             = KillSwitches.shared("link-proxy")

    def forward(incoming: Incoming): Future[Done] =
      val server = BidiFlow
        .fromFlows(switch.flow, switch.flow)
        .atop(link.connection(TransportError.Lost(to, "the link broke"), isDatagrams))
        .joinMat(transport.connect(to))(Keep.right)
      val (sent, (reached, answered)) = incoming.flow
        .watchTermination()(Keep.right)
        .joinMat(server.watchTermination()(Keep.both))(Keep.both)
        .run()
      reached.failed.foreach(unreachable)
      for
        _ <- sent.recover(_ => Done)
        _ <- answered.recover(_ => Done)
      yield Done

    transport
      .listen(listenAt)
      .mapAsyncUnordered(maxConnections)(forward)
      .toMat(Sink.ignore)(Keep.left)
      .run()
      .map(LinkProxy(_, link, switch))
