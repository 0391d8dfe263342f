package skein.solver

import java.io.IOException
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.{KillSwitches, SharedKillSwitch}
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Try
import skein.link.{Address, Incoming, Listening, Seats, Transport}
import skein.units.{Clock, Span}

/** A solver that flights connect to; see [[TcpLink]]. A peer that sends invalid messages, or none at first,
  * loses its connection without further effect. If all seats are taken, a connection without useful messages
  * is closed to make room for a new one; its flight, if there is one, connects again.
  */
final class SolverServer private (listening: Listening, switch: SharedKillSwitch, seats: Seats):
  def address: Address = listening.address

  /** Number of connections without useful messages that were closed to make room for other connections. */
  def displacedConnections: Long = seats.displacedConnections

  /** Number of connections that were refused for lack of a seat. */
  def refusedConnections: Long = seats.refusedConnections

  /** Accepts no more connections and closes the open ones. */
  def close(): Future[Done] =
    switch.shutdown()
    listening.close()

object SolverServer:
  val MostConnections = 64

  /** Time-out of the first message: a flight says hello as soon as it is connected. */
  private val FirstWithin = Span.ofSeconds(10)

  /** Starts a server. Fails with a [[skein.link.TransportError]] if it cannot listen.
    *
    * @param clock measures how long connections have been silent
    */
  def start(at: Address, transport: Transport, desk: SolverDesk, clock: Clock)(using
      ActorSystem
  ): Future[SolverServer] =
    given ExecutionContext = ExecutionContext.parasitic
    val switch             = KillSwitches.shared("solver-server")
    val seats              = Seats(MostConnections, clock)

    def accept(incoming: Incoming): Unit =
      val own = KillSwitches.shared("solver-connection")
      // The displaced peer may not read, so nothing is awaited.
      seats.enter(() => own.abort(Displaced)) match
        case None       => Source.empty[ByteString].via(incoming.flow).runWith(Sink.cancelled): Unit
        case Some(seat) => serve(incoming, seat, own)

    def serve(incoming: Incoming, seat: Seats.Seat, own: SharedKillSwitch): Unit =
      val (out, replies) = Source.queue[ByteString](TcpLink.MostWaiting).preMaterialize()
      // A message that does not fit is lost, as on any link; the flight repeats its request.
      def reply(message: Array[Byte]): Unit = out.offer(ByteString.fromArrayUnsafe(message)): Unit
      replies
        .via(switch.flow)
        .via(own.flow)
        .via(TcpLink.framed.join(incoming.flow))
        .via(own.flow)
        .initialTimeout(FirstWithin.toDuration)
        .runForeach: message =>
          desk
            .received(Seq(message.toArrayUnsafe()), reply)
            .fold(mistake => throw IOException(mistake), isOfUse => if isOfUse then seat.spoke())
        .onComplete: _ =>
          seat.left()
          Try(if !out.isCompleted then out.complete())

    transport
      .listen(at)
      .to(Sink.foreach(accept))
      .run()
      .map(SolverServer(_, switch, seats))

  private object Displaced extends IOException("another connection has its place")
