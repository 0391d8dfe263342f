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

/** A solver that flights connect to; see [[TcpLink]]. Whoever sends what is no message, or says nothing at
  * first, loses the connection, and nothing else happens. A connection that says nothing of use makes room
  * for another when all places are taken; its flight, if there is one, connects again.
  */
final class SolverServer private (listening: Listening, switch: SharedKillSwitch, seats: Seats):
  /** With the actual port. */
  def address: Address = listening.address

  /** Connections that said nothing of use and made room for others. */
  def displacedConnections: Long = seats.displacedConnections

  /** Connections for which there was no place. */
  def refusedConnections: Long = seats.refusedConnections

  /** Accepts no more and closes the open connections. */
  def close(): Future[Done] =
    switch.shutdown()
    listening.close()

object SolverServer:
  /** Open at the same time. */
  val MostConnections = 64

  /** A flight says hello as soon as it is connected. */
  private val FirstWithin = Span.ofSeconds(10)

  /** Fails with a [[skein.link.TransportError]] where it cannot listen.
    *
    * @param clock tells how long connections have been silent
    */
  def start(at: Address, transport: Transport, desk: SolverDesk, clock: Clock)(using
      ActorSystem
  ): Future[SolverServer] =
    given ExecutionContext = ExecutionContext.parasitic
    val switch             = KillSwitches.shared("solver-server")
    val seats              = Seats(MostConnections, clock)

    def accept(incoming: Incoming): Unit =
      val own = KillSwitches.shared("solver-connection")
      // Its peer may not read what it is sent, so nothing is waited for.
      seats.enter(() => own.abort(Displaced)) match
        case None       => Source.empty[ByteString].via(incoming.flow).runWith(Sink.cancelled): Unit
        case Some(seat) => serve(incoming, seat, own)

    def serve(incoming: Incoming, seat: Seats.Seat, own: SharedKillSwitch): Unit =
      val (out, replies) = Source.queue[ByteString](TcpLink.MostWaiting).preMaterialize()
      // What does not fit is lost, as on any link; the flight asks again.
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
