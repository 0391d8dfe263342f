package skein.link

import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicInteger
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.stream.{Attributes, BoundedSourceQueue, KillSwitches, QueueOfferResult}
import org.apache.pekko.util.ByteString
import org.apache.pekko.{Done, NotUsed}
import org.reactivestreams.{Publisher, Subscriber}
import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Failure, Success, Try}
import skein.signal.SplitMix64
import skein.units.*

/** Hosts and emulated links between them, all in memory: the transport of virtual time. It runs in real time
  * as well.
  *
  * A host's name serves as its address; `127.0.0.1` and `localhost` mean the host itself. Connecting takes a
  * round trip of the link. As with TCP, each direction of a connection closes separately; a failing side
  * breaks both; while a host is silent, connections stay open without an error, and attempts to connect end
  * with [[TransportError.NoAnswer]].
  *
  * On one thread the seed determines everything.
  *
  * @param connectTimeout time after which an unanswered attempt to connect fails
  * @param backlog maximum number of connections that wait to be accepted by one listener; further attempts
  *   are not answered
  */
final class MemoryNetwork(
    plan: NetworkPlan,
    seed: Long,
    clock: Clock,
    connectTimeout: Span = Span.ofSeconds(5),
    backlog: Int = 256
)(using system: ActorSystem):
  import MemoryNetwork.*
  private given ExecutionContext = system.dispatcher

  private val start = clock.now()
  private val links = ConcurrentHashMap[(String, String), EmulatedLink]()
  private val hosts = ConcurrentHashMap[String, Host]()

  /** The transport for programs on this host. */
  def host(name: String): Transport = hosts.computeIfAbsent(name, Host(_))

  /** Traffic counts of the link between a client's host and a server's, in both directions. */
  def counts(client: String, server: String): LinkCounts = link(client, server).counts

  private def link(client: String, server: String): EmulatedLink =
    links.computeIfAbsent(
      (client, server),
      _ =>
        EmulatedLink(
          plan.between(client, server),
          SplitMix64.seedOf(seed, s"$client>$server".hashCode),
          clock,
          start
        )
    )

  private final class Host(name: String) extends Transport:
    private val listeners  = ConcurrentHashMap[Int, BoundedSourceQueue[Incoming]]()
    private val portsGiven = AtomicInteger()

    def connect(to: Address): Flow[ByteString, ByteString, Future[Done]] =
      Flow
        .fromMaterializer: (_, _) =>
          val connection = establish(to)
          Flow
            .futureFlow(connection)
            // A client that cancels while it connects closes the connection once it is open.
            .withAttributes(Attributes(PropagateToNested))
            .mapMaterializedValue(_ => connection.map(_ => Done))
        .mapMaterializedValue(_.flatten)

    def listen(at: Address): Source[Incoming, Future[Listening]] =
      Source
        .queue[Incoming](backlog)
        .watchTermination(): (queue, done) =>
          def take(port: Int) = isSelf(at.host) && listeners.putIfAbsent(port, queue) == null
          val port            =
            if at.port != 0 then Some(at.port).filter(take)
            else Iterator.fill(freePorts.size)(nextPort()).find(take)
          port match
            case _ if !isSelf(at.host) =>
              refuse(queue, TransportError.CannotListen(at, s"$name has no such address"))
            case None       => refuse(queue, TransportError.PortTaken(at))
            case Some(port) =>
              def forget() = listeners.remove(port, queue): Unit
              done.onComplete(_ => forget())
              Future.successful(listening(Address(at.host, port), queue, forget))

    private def establish(to: Address): Future[Flow[ByteString, ByteString, NotUsed]] =
      val server = if isSelf(to.host) then name else to.host
      if !hosts.containsKey(server) then Future.failed(TransportError.UnknownHost(to))
      else
        val over   = link(name, server)
        val client = Address(name, nextPort())
        over.handshake() match
          case Some((toServer, toClient)) if toServer + toClient <= connectTimeout =>
            afterwards(toServer)(Future.successful(hosts.get(server).accept(client, to, over))).flatMap:
              case Some(answer) => afterwards(toClient)(Future.fromTry(answer))
              case None         => noAnswer(to, connectTimeout - toServer)
          case _ => noAnswer(to, connectTimeout)

    /** The server's half of connecting: the client's end of the new connection, or a refusal. None if too
      * many wait.
      */
    private def accept(
        client: Address,
        to: Address,
        link: EmulatedLink
    ): Option[Try[Flow[ByteString, ByteString, NotUsed]]] =
      val refused = Failure(TransportError.NobodyListens(to))
      Option(listeners.get(to.port)) match
        case None                                   => Some(refused)
        case Some(queue) if queue.size() >= backlog => None
        case Some(queue)                            =>
          val (clientEnd, serverEnd) = open(link, client, to)
          queue.offer(Incoming(client, serverEnd)) match
            case QueueOfferResult.Enqueued => Some(Success(clientEnd))
            case _                         => Some(refused)

    private def noAnswer(to: Address, after: Span): Future[Nothing] =
      afterwards(after)(Future.failed(TransportError.NoAnswer(to, connectTimeout)))

    /** The next free port, for outgoing connections and for listeners on port 0. */
    private def nextPort(): Int = freePorts(Math.floorMod(portsGiven.getAndIncrement(), freePorts.size))

    private def isSelf(address: String) = address == name || loopback.contains(address)

    private def afterwards[A](delay: Span)(result: => Future[A]): Future[A] =
      after(delay.toDuration, system.scheduler)(result)

    private def refuse(queue: BoundedSourceQueue[Incoming], error: TransportError): Future[Listening] =
      queue.fail(error)
      Future.failed(error)

  /** Makes a connection's two ends: the client's and the server's. */
  private def open(link: EmulatedLink, client: Address, server: Address) =
    val port = Flow.fromSinkAndSourceMat(
      Sink.asPublisher[ByteString](fanout = false),
      Source.asSubscriber[ByteString]
    )(Keep.both)
    val broken                                           = TransportError.Lost(server, "the link broke")
    val ((toClient, fromClient), (toServer, fromServer)) =
      port.joinMat(link.connection(broken).joinMat(port)(Keep.right))(Keep.both).run()
    (end(server, toClient, fromClient), end(client, toServer, fromServer))

object MemoryNetwork:
  private val freePorts         = 49152 to 65535
  private val loopback          = Set("127.0.0.1", "localhost")
  private val PropagateToNested = Attributes.NestedMaterializationCancellationPolicy.PropagateToNested

  private def listening(at: Address, queue: BoundedSourceQueue[Incoming], forget: () => Unit): Listening =
    new Listening:
      val address: Address      = at
      def close(): Future[Done] =
        forget()
        if !queue.isCompleted then queue.complete()
        Future.successful(Done)

  /** One end of a connection. A reset of the direction towards it also ends the other direction. */
  private def end(
      peer: Address,
      received: Publisher[ByteString],
      sent: Subscriber[ByteString]
  ): Flow[ByteString, ByteString, NotUsed] =
    val sending = KillSwitches.shared("sending")
    Flow.fromSinkAndSource(
      Flow[ByteString].via(sending.flow).to(Sink.fromSubscriber(sent)),
      Source
        .fromPublisher(received)
        .mapError: failure =>
          val lost = failure match
            case TransportError.Lost(_, reason) => TransportError.Lost(peer, reason)
            case _                              => TransportError.Lost(peer, "reset by the other side")
          sending.abort(lost)
          lost
    )
