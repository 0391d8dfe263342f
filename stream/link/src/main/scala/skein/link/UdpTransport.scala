package skein.link

import java.net.{
  BindException,
  DatagramPacket,
  DatagramSocket,
  InetAddress,
  InetSocketAddress,
  SocketException,
  UnknownHostException
}
import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.LongAdder
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.BoundedSourceQueue
import org.apache.pekko.stream.QueueOfferResult
import org.apache.pekko.stream.scaladsl.{Flow, Sink, Source}
import org.apache.pekko.util.ByteString
import org.apache.pekko.{Done, NotUsed}
import scala.concurrent.{ExecutionContext, Future}
import scala.jdk.CollectionConverters.*
import scala.util.Try
import skein.units.Span

/** Treats datagrams as connections: each sender to a port is one connection, until it has been silent for
  * `idle`. Each piece of bytes is one datagram, sent and received whole; one of more than 65,507 bytes is
  * dropped. The end of the other side is not reported, and lost datagrams stay lost.
  *
  * @param mostPeers maximum number of peers at one port. A further one takes the place of the one that has
  *   been silent for longest, if that is at least [[UdpSocket.Silence]]; else its datagrams are dropped
  */
final class UdpTransport(mostPeers: Int = 64, idle: Span = Span.ofSeconds(30))(using ActorSystem)
    extends Transport:

  def connect(to: Address): Flow[ByteString, ByteString, Future[Done]] =
    Flow
      .lazyFutureFlow: () =>
        Future.fromTry(Try:
          val peer  = UdpSocket.resolved(to)
          val local = if peer.getAddress.isLoopbackAddress then "127.0.0.1" else "0.0.0.0"
          val port  = UdpSocket.bind(Address(local, 0), mostPeers = 0, idle)
          port.peer(to, onEnd = () => port.close()))
      // A port is open as soon as there is a first datagram to send; there is nothing to wait for.
      .mapMaterializedValue(_ => Future.successful(Done))

  def listen(at: Address): Source[Incoming, Future[Listening]] =
    Source
      .queue[Incoming](mostPeers)
      .mapMaterializedValue: queue =>
        Try(UdpSocket.bind(at, mostPeers, idle)).fold(
          error =>
            queue.fail(error)
            Future.failed(error)
          ,
          socket =>
            socket.onPeer(incoming => queue.offer(incoming): Unit)
            Future.successful(new Listening:
              val address: Address      = socket.address
              def close(): Future[Done] =
                socket.close()
                queue.complete()
                Future.successful(Done))
        )

/** An open UDP port, with a receiving thread of its own.
  *
  * @param speaks whether a datagram belongs to the port's protocol: only such ones make their sender a peer
  * @param dropped number of datagrams of peers beyond the limit, of another protocol, or that arrived faster
  *   than they were handled
  */
final class UdpSocket private (
    socket: DatagramSocket,
    mostPeers: Int,
    idle: Span,
    speaks: ByteString => Boolean,
    val dropped: LongAdder
)(using system: ActorSystem):
  import UdpSocket.*
  private given ExecutionContext = ExecutionContext.parasitic

  private val peers             = ConcurrentHashMap[InetSocketAddress, Peer]()
  @volatile private var tellNew = Option.empty[Incoming => Unit]

  val address: Address = Address(socket.getLocalAddress.getHostAddress, socket.getLocalPort)

  /** Sets the function that is called with every new peer. */
  def onPeer(tell: Incoming => Unit): Unit = tellNew = Some(tell)

  /** A flow to an address: sends datagrams to it and emits those received from it; to be materialised once.
    */
  def peer(to: Address, onEnd: () => Unit = () => ()): Flow[ByteString, ByteString, NotUsed] =
    open(resolved(to), isLasting = true, onEnd).flow

  def close(): Unit =
    socket.close()
    peers.forEach((_, peer) => peer.end())
    peers.clear()

  private final class Peer(at: InetSocketAddress, isLasting: Boolean, onEnd: () => Unit):
    private val (queue, source): (BoundedSourceQueue[ByteString], Source[ByteString, NotUsed]) =
      Source.queue[ByteString](Waiting).preMaterialize()
    @volatile private var heardNs = System.nanoTime()

    /** Time since the peer's last datagram; zero for a lasting peer. */
    def silentFor: Span = if isLasting then Span.Zero else Span.ofNanos(System.nanoTime() - heardNs)

    def heard(bytes: ByteString): Unit =
      heardNs = System.nanoTime()
      if queue.offer(bytes) != QueueOfferResult.Enqueued then dropped.increment()

    /** Another thread may end the stream meanwhile, and completing its queue then throws. */
    def end(): Unit =
      val _ = Try(if !queue.isCompleted then queue.complete())

    val flow: Flow[ByteString, ByteString, NotUsed] =
      Flow.fromSinkAndSourceCoupled(
        Sink
          .foreach[ByteString](send(at, _))
          .mapMaterializedValue(_.onComplete: _ =>
            // By then another datagram may have been received from it.
            peers.remove(at, this)
            onEnd()),
        source
      )

  private def send(to: InetSocketAddress, bytes: ByteString): Unit =
    // There may be no receiver, and the line may be full: datagrams guarantee nothing.
    try socket.send(DatagramPacket(bytes.toArrayUnsafe(), bytes.size, to))
    catch case _: java.io.IOException => dropped.increment()

  private def open(at: InetSocketAddress, isLasting: Boolean, onEnd: () => Unit): Peer =
    val peer = Peer(at, isLasting, onEnd)
    peers.put(at, peer)
    peer

  private def receive(): Unit =
    val packet = DatagramPacket(new Array[Byte](1 << 16), 1 << 16)
    while !socket.isClosed do
      try
        socket.receive(packet)
        val from  = packet.getSocketAddress.asInstanceOf[InetSocketAddress]
        val bytes = ByteString.fromArray(packet.getData, packet.getOffset, packet.getLength)
        packet.setLength(1 << 16)
        forgetIdle()
        Option(peers.get(from)).orElse(Option.when(speaks(bytes))(from).flatMap(admitted)) match
          case Some(peer) => peer.heard(bytes)
          case None       => dropped.increment()
      catch case _: java.io.IOException => ()

  private def admitted(from: InetSocketAddress): Option[Peer] =
    for tell <- tellNew if peers.size < mostPeers || vacated() yield
      val peer = open(from, isLasting = false, () => ())
      tell(Incoming(Address(from.getAddress.getHostAddress, from.getPort), peer.flow))
      peer

  private def forgetIdle(): Unit = peers.forEach: (at, peer) =>
    if peer.silentFor > idle then forget(at, peer)

  /** Removes the peer that has been silent for longest, if that is long enough; returns whether there was
    * one.
    */
  private def vacated(): Boolean =
    val silent = peers.asScala.maxByOption(_._2.silentFor).filter(_._2.silentFor >= Silence)
    silent.foreach(forget)
    silent.isDefined

  private def forget(at: InetSocketAddress, peer: Peer): Unit =
    peers.remove(at, peer): Unit
    peer.end()

object UdpSocket:
  /** Opens the port; fails with a [[TransportError]]. */
  def bind(
      at: Address,
      mostPeers: Int = 64,
      idle: Span = Span.ofSeconds(30),
      speaks: ByteString => Boolean = _ => true
  )(using ActorSystem): UdpSocket =
    val socket =
      try DatagramSocket(resolved(at))
      catch
        case e: BindException if e.getMessage.contains("in use") => throw TransportError.PortTaken(at)
        case e: SocketException => throw TransportError.CannotListen(at, e.getMessage)
    socket.setReceiveBufferSize(1 << 20)
    val opened = UdpSocket(socket, mostPeers, idle, speaks, LongAdder())
    Thread.ofPlatform().daemon().name(s"udp-${opened.address}").start(() => opened.receive())
    opened

  private[link] def resolved(at: Address): InetSocketAddress =
    try InetSocketAddress(InetAddress.getByName(at.host), at.port)
    catch case _: UnknownHostException => throw TransportError.UnknownHost(at)

  /** A peer that was silent for this long loses its place when another peer needs it. */
  val Silence: Span = Span.ofSeconds(2)

  /** Maximum number of one peer's received datagrams that wait. */
  private val Waiting = 256
