package skein.simulator

import java.util.concurrent.atomic.AtomicLong
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.stream.{BoundedSourceQueue, KillSwitches, SharedKillSwitch}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.{Failure, Success, Try}
import skein.hil.AutopilotKind
import skein.link.{Address, FirstBytes, Listening, Places, Transport, TransportError, UdpSocket}
import skein.mavlink.FrameReader
import skein.units.Span

/** The ports of vehicles that speak a protocol other than AirSim's.
  *
  * @param streams ports for streams, by the simulator's own transport, which is TCP outside tests
  * @param datagrams ports for datagrams, whatever the transport
  */
private[simulator] final case class PeerPorts(
    streams: Vector[PeerPort] = Vector.empty,
    datagrams: Vector[PeerPort] = Vector.empty
)

/** A port of some vehicles. It answers every peer that sends to it.
  *
  * @param systems system numbers of the vehicles, from 1; empty: all
  * @param mostPeers maximum number of simultaneous peers
  * @param tells a peer that receives messages without having sent one
  * @param isOneWay whether only `tells` receives messages, and other senders' datagrams count as its
  * @param speaks whether a datagram, or the bytes of a stream so far, contain a message of the port's
  *   protocol
  */
private[simulator] final case class PeerPort(
    at: Address,
    systems: Vector[Int] = Vector.empty,
    mostPeers: Int = PeerServer.MostPeers,
    tells: Option[Address] = None,
    isOneWay: Boolean = false,
    speaks: Array[Byte] => Boolean = FrameReader.isSpoken
)

private[simulator] object PeerPorts:
  def of(settings: MavlinkSettings): PeerPorts = PeerPorts(
    settings.listen.map(PeerPort(_)).toVector,
    settings.udp.map(port => PeerPort(port.at, port.systems, PeerServer.MostDatagramPeers, port.tells))
  )

  def of(settings: HilSettings): PeerPorts =
    val ports = settings.ports.zipWithIndex.map((at, index) =>
      PeerPort(at, Vector(index + 1), mostPeers = 1, speaks = settings.autopilot.speaks)
    )
    settings.autopilot match
      case AutopilotKind.Px4        => PeerPorts(streams = ports)
      case AutopilotKind.ArduPilot  => PeerPorts(datagrams = ports)
      case AutopilotKind.Betaflight =>
        PeerPorts(datagrams = ports.map(_.copy(tells = Some(settings.stateTo), isOneWay = true)))

/** A peer of some vehicles.
  *
  * @param systems system numbers of the vehicles, from 1; empty: all
  * @param isDatagrams whether it sends datagrams, and not a stream
  * @param out receives the bytes for it
  */
private[simulator] final case class JoinedPeer(
    channel: Long,
    systems: Vector[Int],
    isDatagrams: Boolean,
    out: BoundedSourceQueue[ByteString]
)

/** Receives the events of peers. Each call may come from any thread. */
private[simulator] trait Peers:
  def joined(peer: JoinedPeer): Unit

  /** Takes bytes; completes `done` when they have been handled. */
  def heard(channel: Long, bytes: Array[Byte], done: Promise[Done]): Unit

  def left(channel: Long): Unit

/** The open ports.
  *
  * @param addresses the listening addresses, with the actual ports: those of streams, then those of datagrams
  */
private[simulator] final class PeerServer(
    val addresses: Vector[Address],
    sockets: Vector[UdpSocket],
    closing: () => Future[Done]
):
  /** Datagrams of peers beyond the limit of a port, or dropped because the simulator was too slow. */
  def ignored: Long = sockets.map(_.dropped.sum).sum

  def close(): Future[Done] = closing()

private[simulator] object PeerServer:
  /** Maximum number of simultaneous peers over all ports; further ones are refused. */
  val MostPeers = 128

  /** Maximum number of simultaneous peers of one datagram port. */
  val MostDatagramPeers = 64

  /** Maximum number of pieces that wait for one peer; further ones are dropped. */
  private val Waiting = 256

  /** Time without a message after which the only peer that its port allows may lose its place to another
    * peer.
    */
  private val AloneIdle = Span.ofSeconds(5)

  /** Time without a message after which a peer may lose its place to another. */
  private val Silence = Span.ofSeconds(5)

  /** A stream's first message must be recognised within this many bytes; the longest has 280. */
  private val MostBefore = 1024

  /** Maximum number of bytes of a stream that are handled in one turn. Other clients' calls run in between.
    */
  private val MostAtOnce = 2048

  /** First bytes of MAVLink 2 and MAVLink 1, the only protocol over streams. */
  private val Starts = Set(0xfd, 0xfe)

  /** Opens all ports; fails with a [[skein.link.TransportError]]. */
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
    val present            = Places(MostPeers, Silence)

    /** @param isKnown whether the peer has sent a message already, or receives messages without having sent
      *   one
      */
    def serve(port: PeerPort, isDatagrams: Boolean, presentHere: Places, isKnown: Boolean)(
        flow: Flow[ByteString, ByteString, ?]
    ): Unit =
      val channel = numbers.getAndIncrement()
      if isAdmitted(channel, Seq(presentHere, present)) then
        val (queue, out) = Source.queue[ByteString](Waiting).preMaterialize()
        val joined       = JoinedPeer(channel, port.systems, isDatagrams, queue)
        val guest        = Guest(KillSwitches.shared(s"peer-$channel"), port.speaks, peers, joined, isKnown)
        val places       = Seq(presentHere, present)
        places.foreach(_.entered(channel, guest))
        if isKnown then guest.join()
        out
          .via(switch.flow)
          .via(guest.switch.flow)
          .via(flow)
          .mapConcat(bytes => if isDatagrams then Iterator(bytes) else bytes.grouped(MostAtOnce))
          .mapAsync(1)(guest.heard)
          .via(guest.switch.flow)
          .runWith(Sink.ignore)
          .onComplete: how =>
            places.foreach(_.left(channel))
            if guest.hasSpoken then peers.left(channel)
            for case _: TransportError.Foreign <- how.failed do counters.foreign.incrementAndGet(): Unit
      else
        counters.turnedAway.incrementAndGet(): Unit
        Source.empty[ByteString].via(flow).runWith(Sink.cancelled): Unit

    // All are counted, even if one is refused.
    def isAdmitted(channel: Long, places: Seq[Places]): Boolean =
      val admitted = places.map(_.admit())
      val all      = admitted.forall(identity)
      if !all then for case (place, true) <- places.zip(admitted) do place.left(channel)
      all

    def open(): Vector[UdpSocket] =
      ports.datagrams.foldLeft(Vector.empty[UdpSocket]): (opened, port) =>
        try
          val isAlone = port.mostPeers == 1
          val here    = Places(port.mostPeers, Silence)
          // A peer that receives messages without having sent one is a peer, too.
          val admitted                  = port.mostPeers + (if port.isOneWay then 1 else 0)
          def speaks(bytes: ByteString) = port.speaks(bytes.toArrayUnsafe())
          val socket                    =
            if isAlone then UdpSocket.bind(port.at, admitted, AloneIdle, speaks)
            else UdpSocket.bind(port.at, admitted, speaks = speaks)
          if port.isOneWay then
            val (heard, in) = Source.queue[ByteString](Waiting).preMaterialize()
            socket.onPeer(incoming =>
              val _ =
                Source.maybe[ByteString].via(incoming.flow).runForeach(bytes => heard.offer(bytes): Unit)
            )
            for to <- port.tells do
              serve(port, isDatagrams = true, here, isKnown = true)(
                Flow.fromSinkAndSourceCoupled(socket.peer(to).to(Sink.ignore), in)
              )
          else
            socket.onPeer(incoming => serve(port, isDatagrams = true, here, isKnown = false)(incoming.flow))
            port.tells.foreach(to => serve(port, isDatagrams = true, here, isKnown = true)(socket.peer(to)))
          opened :+ socket
        catch
          case error: Throwable =>
            opened.foreach(_.close())
            throw error

    def listen(): Future[Vector[Listening]] =
      ports.streams.foldLeft(Future.successful(Vector.empty[Listening])): (opened, port) =>
        opened.flatMap: before =>
          val here = Places(port.mostPeers, Silence)
          transport
            .listen(port.at)
            .toMat(
              Sink.foreach: incoming =>
                val own = incoming.flow.via(FirstBytes.guard(incoming.from, Starts))
                serve(port, isDatagrams = false, here, isKnown = false)(own)
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

  /** A connection that becomes a peer with its first message; until then it receives nothing. */
  private final class Guest(
      val switch: SharedKillSwitch,
      speaks: Array[Byte] => Boolean,
      peers: Peers,
      joined: JoinedPeer,
      isKnown: Boolean
  ) extends Places.Guest:
    @volatile private var spoken  = false
    @volatile private var heardNs = System.nanoTime()
    private var before            = ByteString.empty

    def hasSpoken: Boolean = spoken
    def silentFor: Span    = if isKnown then Span.Zero else Span.ofNanos(System.nanoTime() - heardNs)
    def leave(): Unit      = switch.shutdown()

    def join(): Unit =
      spoken = true
      peers.joined(joined)

    def heard(bytes: ByteString): Future[Done] =
      heardNs = System.nanoTime()
      if spoken then told(bytes)
      else
        before = before ++ bytes
        if speaks(before.toArrayUnsafe()) then
          join()
          told(before)
        else if before.length < MostBefore then Future.successful(Done)
        else
          Future.failed(TransportError.Foreign(
            Address("", 0),
            s"${before.length} bytes without a message of it"
          ))

    private def told(bytes: ByteString): Future[Done] =
      val done = Promise[Done]()
      peers.heard(joined.channel, bytes.toArrayUnsafe(), done)
      done.future
