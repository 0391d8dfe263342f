package skein.simulator

import java.util.concurrent.atomic.{AtomicInteger, AtomicLong}
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.stream.{BoundedSourceQueue, KillSwitches}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.{Failure, Success, Try}
import skein.hil.AutopilotKind
import skein.link.{Address, Listening, Transport, UdpSocket}
import skein.units.Span

/** Where peers reach vehicles by another protocol than AirSim's.
  *
  * @param streams by the simulator's own transport, which is TCP where that is real
  * @param datagrams by datagrams, whatever the transport
  */
private[simulator] final case class PeerPorts(
    streams: Vector[PeerPort] = Vector.empty,
    datagrams: Vector[PeerPort] = Vector.empty
)

/** A port of some vehicles. It answers everybody who speaks to it.
  *
  * @param systems the vehicles, from 1; none is all
  * @param mostPeers at a time
  * @param tells who is told without having asked
  * @param isOneWay whether only that one is told, and what others send counts as its
  */
private[simulator] final case class PeerPort(
    at: Address,
    systems: Vector[Int] = Vector.empty,
    mostPeers: Int = PeerServer.MostPeers,
    tells: Option[Address] = None,
    isOneWay: Boolean = false
)

private[simulator] object PeerPorts:
  def of(settings: MavlinkSettings): PeerPorts = PeerPorts(
    settings.listen.map(PeerPort(_)).toVector,
    settings.udp.map(port => PeerPort(port.at, port.systems, PeerServer.MostDatagramPeers, port.tells))
  )

  def of(settings: HilSettings): PeerPorts =
    val ports = settings.ports.zipWithIndex.map((at, index) => PeerPort(at, Vector(index + 1), mostPeers = 1))
    settings.autopilot match
      case AutopilotKind.Px4        => PeerPorts(streams = ports)
      case AutopilotKind.ArduPilot  => PeerPorts(datagrams = ports)
      case AutopilotKind.Betaflight =>
        PeerPorts(datagrams = ports.map(_.copy(tells = Some(settings.stateTo), isOneWay = true)))

/** Somebody who speaks to vehicles.
  *
  * @param systems the vehicles, from 1; none is all
  * @param isDatagrams whether by datagrams, and not by a stream
  * @param out what goes to it
  */
private[simulator] final case class JoinedPeer(
    channel: Long,
    systems: Vector[Int],
    isDatagrams: Boolean,
    out: BoundedSourceQueue[ByteString]
)

/** What is done with what peers send. Each call may come from any thread. */
private[simulator] trait Peers:
  def joined(peer: JoinedPeer): Unit

  /** Completes `done` when it has been dealt with. */
  def heard(channel: Long, bytes: Array[Byte], done: Promise[Done]): Unit

  def left(channel: Long): Unit

/** The open ports.
  *
  * @param addresses with the actual ports: those of streams, then those of datagrams
  */
private[simulator] final class PeerServer(
    val addresses: Vector[Address],
    sockets: Vector[UdpSocket],
    closing: () => Future[Done]
):
  /** Datagrams of peers beyond the limit of a port, or for which the simulator was not quick enough. */
  def ignored: Long = sockets.map(_.dropped.sum).sum

  def close(): Future[Done] = closing()

private[simulator] object PeerServer:
  /** Peers at a time, over all ports; others are turned away. */
  val MostPeers = 128

  /** Of a port of datagrams. */
  val MostDatagramPeers = 64

  /** Pieces for one peer that may wait; later ones are dropped. */
  private val Waiting = 256

  /** A peer that is alone at its port makes room when nothing was heard of it for this long. */
  private val AloneIdle = Span.ofSeconds(5)

  /** Fails with a [[skein.link.TransportError]]. */
  def start(
      ports: PeerPorts,
      transport: Transport,
      peers: Peers,
      counters: PeerCounters
  )(using
      system: ActorSystem
  ): Future[PeerServer] =
    given ExecutionContext = ExecutionContext.parasitic
    val switch             = KillSwitches.shared("peers")
    val numbers            = AtomicLong()
    val present            = AtomicInteger()

    def serve(port: PeerPort, isDatagrams: Boolean, presentHere: AtomicInteger)(
        flow: Flow[ByteString, ByteString, ?]
    ): Unit =
      val counts = Seq(present -> MostPeers, presentHere -> port.mostPeers)
      // All are counted, whatever one of them says.
      if counts.map((count, most) => count.incrementAndGet() <= most).forall(identity) then
        val (queue, out) = Source.queue[ByteString](Waiting).preMaterialize()
        val channel      = numbers.getAndIncrement()
        peers.joined(JoinedPeer(channel, port.systems, isDatagrams, queue))
        out
          .via(switch.flow)
          .via(flow)
          .mapAsync(1): bytes =>
            val done = Promise[Done]()
            peers.heard(channel, bytes.toArrayUnsafe(), done)
            done.future
          .runWith(Sink.ignore)
          .onComplete: _ =>
            counts.foreach((count, _) => count.decrementAndGet())
            peers.left(channel)
      else
        counts.foreach((count, _) => count.decrementAndGet())
        counters.turnedAway.incrementAndGet(): Unit
        Source.empty[ByteString].via(flow).runWith(Sink.cancelled): Unit

    def open(): Vector[UdpSocket] =
      ports.datagrams.foldLeft(Vector.empty[UdpSocket]): (opened, port) =>
        try
          val isAlone = port.mostPeers == 1
          val here    = AtomicInteger()
          // Who is told without having asked is a peer, too.
          val admitted = port.mostPeers + (if port.isOneWay then 1 else 0)
          val socket   =
            if isAlone then UdpSocket.bind(port.at, admitted, AloneIdle)
            else UdpSocket.bind(port.at, admitted)
          if port.isOneWay then
            val (heard, in) = Source.queue[ByteString](Waiting).preMaterialize()
            socket.onPeer(incoming =>
              val _ =
                Source.maybe[ByteString].via(incoming.flow).runForeach(bytes => heard.offer(bytes): Unit)
            )
            for to <- port.tells do
              serve(port, isDatagrams = true, here)(
                Flow.fromSinkAndSourceCoupled(socket.peer(to).to(Sink.ignore), in)
              )
          else
            socket.onPeer(incoming => serve(port, isDatagrams = true, here)(incoming.flow))
            port.tells.foreach(to => serve(port, isDatagrams = true, here)(socket.peer(to)))
          opened :+ socket
        catch
          case error: Throwable =>
            opened.foreach(_.close())
            throw error

    def listen(): Future[Vector[Listening]] =
      ports.streams.foldLeft(Future.successful(Vector.empty[Listening])): (opened, port) =>
        opened.flatMap: before =>
          val here = AtomicInteger()
          transport
            .listen(port.at)
            .toMat(
              Sink.foreach(incoming => serve(port, isDatagrams = false, here)(incoming.flow))
            )(Keep.left)
            .run()
            .transformWith:
              case Success(one)   => Future.successful(before :+ one)
              case Failure(error) => closed(before).flatMap(_ => Future.failed(error))

    def closed(listening: Vector[Listening]): Future[Done] =
      Future.sequence(listening.map(_.close())).map(_ => Done)

    for
      sockets   <- Future.fromTry(Try(open()))
      listening <- listen().recoverWith: error =>
        sockets.foreach(_.close())
        Future.failed(error)
    yield PeerServer(
      listening.map(_.address) ++ sockets.map(_.address),
      sockets,
      () =>
        switch.shutdown()
        sockets.foreach(_.close())
        closed(listening)
    )
