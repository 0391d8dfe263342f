package skein.link

import java.util.concurrent.ConcurrentHashMap
import org.apache.pekko.{Done, NotUsed}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{BidiFlow, Flow, Keep, Sink, Source}
import org.apache.pekko.stream.{KillSwitches, SharedKillSwitch}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.jdk.CollectionConverters.*
import skein.units.Span

/** Puts an emulated link between clients and a server: it listens, and forwards each connection that it
  * accepts to the server's address, over the link in both directions. A client that connects while the server
  * does not listen sees its connection break.
  *
  * A connection is accepted without delay; only its data are delayed. With datagrams, every sender is a
  * connection. A stream that begins as HTTP or TLS is closed, and nothing of it is forwarded
  * ([[FirstBytes]]): a browser cannot reach the server through the link.
  */
final class LinkProxy private (
    listening: Listening,
    link: EmulatedLink,
    switch: SharedKillSwitch,
    open: java.util.Set[Promise[Done]]
)(using system: ActorSystem):

  /** The address that clients connect to, with the actual port. */
  def address: Address = listening.address

  def counts: LinkCounts = link.counts

  /** Completes when every connection has ended and what was sent on it has left the link, at the latest after
    * `most`.
    */
  def ended(most: Span): Future[Done] =
    given ExecutionContext      = ExecutionContext.parasitic
    def allClosed: Future[Done] =
      if open.isEmpty then Future.successful(Done)
      else Future.traverse(open.asScala.toSeq)(_.future).flatMap(_ => allClosed)
    Future.firstCompletedOf(
      Seq(allClosed, after(most.toDuration, system.scheduler)(Future.successful(Done)))
    )

  /** Stops accepting and closes the open connections. */
  def close(): Future[Done] =
    switch.shutdown()
    listening.close()

object LinkProxy:

  /** Starts listening. Fails with a [[TransportError]] if that is not possible.
    *
    * @param maxConnections maximum number of open connections. A further one takes the place of the first
    *   without any data yet, or of the one that has been silent for longest, if that is at least 5 s; else it
    *   is closed
    * @param unreachable called with the reason when the server of an accepted connection cannot be reached
    * @param isDatagrams whether the transport carries datagrams: see [[EmulatedLink.connection]]
    * @param watching observes each connection's bytes at the client's side of the link, so with the link's
    *   delay
    * @param beside makes a stage at the server's side of the link for each connection; unlike `watching`, the
    *   stage may remove bytes and add new ones
    */
  def start(
      listenAt: Address,
      to: Address,
      link: EmulatedLink,
      transport: Transport,
      maxConnections: Int = 1024,
      unreachable: Throwable => Unit = _ => (),
      isDatagrams: Boolean = false,
      watching: Watching = Watching.Nobody,
      beside: () => Passing = () => BidiFlow.identity
  )(using ActorSystem): Future[LinkProxy] =
    given ExecutionContext = ExecutionContext.parasitic
    val switch             = KillSwitches.shared("link-proxy")
    val seats              = Seats(maxConnections, link.clock)
    val open               = ConcurrentHashMap.newKeySet[Promise[Done]]()

    def forward(incoming: Incoming, seat: Seats.Seat, own: SharedKillSwitch): Unit =
      // Data from either side keep the seat.
      val noting = Flow[ByteString].via(own.flow).map: bytes =>
        seat.spoke()
        bytes
      val first  = if isDatagrams then Flow[ByteString] else FirstBytes.guard(incoming.from)
      val client = incoming.flow.via(first).via(noting)
      val server = watching
        .opened(seat.number)
        .atop(BidiFlow.fromFlows(switch.flow, noting.via(switch.flow)))
        .atop(link.connection(TransportError.Lost(to, "the link broke"), isDatagrams))
        .atop(beside())
        .joinMat(watched(transport.connect(to)))(Keep.right)
      val closed = Promise[Done]()
      open.add(closed): Unit
      val (sent, ((gone, reached, silent), answered)) = client
        .watchTermination()(Keep.right)
        .joinMat(server.watchTermination()(Keep.both))(Keep.both)
        .run()
      reached.failed.foreach(unreachable)
      sent.failed.foreach:
        case foreign: TransportError.Foreign => unreachable(foreign)
        case _                               => ()
      sent.onComplete: _ =>
        answered.onComplete: _ =>
          watching.closed(seat.number)
          seat.left()
          gone.onComplete: _ =>
            silent.onComplete: _ =>
              open.remove(closed): Unit
              closed.success(Done)

    def accept(incoming: Incoming): Unit =
      val own = KillSwitches.shared("link-proxy-connection")
      seats.enter(() => own.shutdown()) match
        case None       => Source.empty[ByteString].via(incoming.flow).runWith(Sink.cancelled): Unit
        case Some(seat) => forward(incoming, seat, own)

    transport
      .listen(listenAt)
      .to(Sink.foreach(accept))
      .run()
      .map(LinkProxy(_, link, switch, open))

  /** A connection to the server, with the ends of what it is sent, of connecting, and of what it answers. */
  private def watched(server: Flow[ByteString, ByteString, Future[Done]]) =
    Flow[ByteString]
      .watchTermination()(Keep.right)
      .viaMat(server)(Keep.both)
      .watchTermination():
        case ((gone, reached), silent) => (gone, reached, silent)

  /** A stage that both directions of a connection pass through; its first side is at the client. */
  type Passing = BidiFlow[ByteString, ByteString, ByteString, ByteString, NotUsed]

  /** Observes the connections of a proxy. Thread-safe. */
  trait Watching:
    /** Called for each accepted connection. Returns a stage that its bytes in both directions pass unchanged.
      */
    def opened(connection: Long): Passing

    /** Called once, when nothing more passes in either direction. */
    def closed(connection: Long): Unit

  object Watching:
    object Nobody extends Watching:
      def opened(connection: Long): Passing = BidiFlow.identity
      def closed(connection: Long): Unit    = ()
