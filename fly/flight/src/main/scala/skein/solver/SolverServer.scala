package skein.solver

import java.io.IOException
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.{KillSwitches, SharedKillSwitch}
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Try
import skein.link.{Address, Incoming, Listening, Transport}
import skein.units.Span

/** A solver that flights connect to; see [[TcpLink]]. Whoever sends what is no message, or says nothing at
  * first, loses the connection, and nothing else happens.
  */
final class SolverServer private (listening: Listening, switch: SharedKillSwitch):
  /** With the actual port. */
  def address: Address = listening.address

  /** Accepts no more and closes the open connections. */
  def close(): Future[Done] =
    switch.shutdown()
    listening.close()

object SolverServer:
  /** Open at the same time; further ones wait to be accepted. */
  val MostConnections = 64

  /** A flight says hello as soon as it is connected. */
  private val FirstWithin = Span.ofSeconds(10)

  /** Fails with a [[skein.link.TransportError]] where it cannot listen. */
  def start(at: Address, transport: Transport, desk: SolverDesk)(using ActorSystem): Future[SolverServer] =
    given ExecutionContext = ExecutionContext.parasitic
    val switch             = KillSwitches.shared("solver-server")

    def serve(incoming: Incoming): Future[Done] =
      val (out, replies) = Source.queue[ByteString](TcpLink.MostWaiting).preMaterialize()
      // What does not fit is lost, as on any link; the flight asks again.
      def reply(message: Array[Byte]): Unit = out.offer(ByteString.fromArrayUnsafe(message)): Unit
      val taken                             = Flow[ByteString].mapConcat: message =>
        desk.received(
          Seq(message.toArrayUnsafe()),
          reply
        ).fold(mistake => throw IOException(mistake), _ => Nil)
      replies
        .via(switch.flow)
        .via(TcpLink.framed.join(incoming.flow))
        .initialTimeout(FirstWithin.toDuration)
        .via(taken)
        .runWith(Sink.ignore)
        .recover(_ => Done)
        .andThen(_ => Try(if !out.isCompleted then out.complete()))

    transport
      .listen(at)
      .mapAsyncUnordered(MostConnections)(serve)
      .toMat(Sink.ignore)(Keep.left)
      .run()
      .map(SolverServer(_, switch))
