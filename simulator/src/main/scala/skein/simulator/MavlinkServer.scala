package skein.simulator

import java.util.concurrent.atomic.{AtomicInteger, AtomicLong}
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.stream.{BoundedSourceQueue, KillSwitches}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.link.{Address, Listening, Transport, UdpSocket}

/** Where the vehicles are reached by MAVLink.
  *
  * @param listen
  *   all vehicles, for who connects there by the simulator's own transport, which is TCP where that is real
  * @param udp
  *   by datagrams, whatever the transport
  */
final case class MavlinkSettings(listen: Option[Address] = None, udp: Vector[MavlinkPort] = Vector.empty)

/** A UDP port of some vehicles. It answers everybody who speaks to it.
  *
  * @param tells
  *   who is told without having asked
  * @param systems
  *   from 1; none is all
  */
final case class MavlinkPort(at: Address, tells: Option[Address] = None, systems: Vector[Int] = Vector.empty)

object MavlinkSettings:
  /** As PX4's simulation has them (`px4-rc.mavlink`): a ground station finds all vehicles at its port 14550, a program
    * vehicle `i` at 14540 + i, both on this machine; and whoever speaks to 18570 has all, too.
    */
  def asPx4(vehicles: Int, host: String = "127.0.0.1"): MavlinkSettings = MavlinkSettings(udp =
    MavlinkPort(Address(host, GroundStation), Some(Address("127.0.0.1", 14550))) +:
      Vector.tabulate(vehicles)(index =>
        MavlinkPort(
          Address(host, 14580 + index),
          Some(Address("127.0.0.1", 14540 + index)),
          Vector(index + 1)
        )
      )
  )

  /** Of all vehicles. */
  val GroundStation = 18570

/** What is done with what peers send. Each call may come from any thread. */
private[simulator] trait MavlinkPeers:
  /** @param isDatagrams
    *   whether it speaks by datagrams, and not by a stream
    */
  def joined(
      channel: Long,
      systems: Vector[Int],
      isDatagrams: Boolean,
      out: BoundedSourceQueue[ByteString]
  ): Unit

  /** Completes `done` when it has been dealt with. */
  def heard(channel: Long, bytes: Array[Byte], done: Promise[Done]): Unit

  def left(channel: Long): Unit

/** The open ports.
  *
  * @param address
  *   where it listens by the simulator's transport
  */
private[simulator] final class MavlinkServer(
    val address: Option[Address],
    sockets: Vector[UdpSocket],
    closing: () => Future[Done]
):
  /** Datagrams of peers beyond the limit of a port, or for which the simulator was not quick enough. */
  def ignored: Long = sockets.map(_.dropped.sum).sum

  def close(): Future[Done] = closing()

private[simulator] object MavlinkServer:
  /** Peers at a time, over all ports; others are turned away. */
  val MostPeers = 128

  /** Datagrams for one peer that may wait; later ones are dropped. */
  private val Waiting = 256

  /** Fails with a [[skein.link.TransportError]]. */
  def start(
      settings: MavlinkSettings,
      transport: Transport,
      peers: MavlinkPeers,
      counters: MavlinkCounters
  )(using
      system: ActorSystem
  ): Future[MavlinkServer] =
    given ExecutionContext = ExecutionContext.parasitic
    val switch             = KillSwitches.shared("mavlink")
    val numbers            = AtomicLong()
    val present            = AtomicInteger()

    def serve(systems: Vector[Int], isDatagrams: Boolean)(flow: Flow[ByteString, ByteString, ?]): Unit =
      val (queue, out) = Source.queue[ByteString](Waiting).preMaterialize()
      val channel      = numbers.getAndIncrement()
      if present.incrementAndGet() > MostPeers then
        counters.turnedAway.incrementAndGet(): Unit
        queue.complete()
      else peers.joined(channel, systems, isDatagrams, queue)
      out
        .via(switch.flow)
        .via(flow)
        .mapAsync(1): bytes =>
          val done = Promise[Done]()
          peers.heard(channel, bytes.toArrayUnsafe(), done)
          done.future
        .runWith(Sink.ignore)
        .onComplete: _ =>
          val _ = present.decrementAndGet()
          peers.left(channel)

    def open(): Vector[UdpSocket] =
      settings.udp.foldLeft(Vector.empty[UdpSocket]): (opened, port) =>
        try
          val socket = UdpSocket.bind(port.at)
          socket.onPeer(incoming => serve(port.systems, isDatagrams = true)(incoming.flow))
          port.tells.foreach(to => serve(port.systems, isDatagrams = true)(socket.peer(to)))
          opened :+ socket
        catch
          case error: Throwable =>
            opened.foreach(_.close())
            throw error

    def listen(): Future[Option[Listening]] = settings.listen match
      case None     => Future.successful(None)
      case Some(at) =>
        transport
          .listen(at)
          .toMat(Sink.foreach(incoming => serve(Vector.empty, isDatagrams = false)(incoming.flow)))(Keep.left)
          .run()
          .map(Some(_))

    for
      sockets   <- Future.fromTry(scala.util.Try(open()))
      listening <- listen()
    yield MavlinkServer(
      listening.map(_.address),
      sockets,
      () =>
        switch.shutdown()
        sockets.foreach(_.close())
        listening.fold(Future.successful(Done))(_.close())
    )
