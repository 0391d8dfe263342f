package skein.link

import java.net.{BindException, ConnectException, InetSocketAddress, UnknownHostException}
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.io.Inet.SocketOption
import org.apache.pekko.io.Tcp.SO
import org.apache.pekko.stream.{BindFailedException, StreamTcpException}
import org.apache.pekko.stream.scaladsl.{Flow, Source, Tcp}
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.Duration
import scala.concurrent.{ExecutionContext, Future}
import skein.units.Span

/** Real sockets. Small messages leave at once (no Nagle), and each direction closes for itself: a side that has
  * finished sending still receives what is on its way.
  *
  * @param connectTimeout
  *   after this long without an answer a connection fails with [[TransportError.NoAnswer]]
  * @param backlog
  *   connections that may wait to be accepted; the operating system refuses more
  */
final class TcpTransport(connectTimeout: Span = Span.ofSeconds(5), backlog: Int = 256)(using
    system: ActorSystem
) extends Transport:
  import TcpTransport.*

  def connect(to: Address): Flow[ByteString, ByteString, Future[Done]] =
    val explain = connectError(to, connectTimeout)
    Tcp(system)
      .outgoingConnection(
        InetSocketAddress.createUnresolved(to.host, to.port),
        options = options,
        halfClose = true,
        connectTimeout = connectTimeout.toDuration,
        idleTimeout = Duration.Inf
      )
      .mapError(explain)
      .mapMaterializedValue(
        _.transform(_ => Done, explain.applyOrElse(_, identity))(using ExecutionContext.parasitic)
      )

  def listen(at: Address): Source[Incoming, Future[Listening]] =
    val explain = listenError(at)
    Tcp(system)
      .bind(at.host, at.port, backlog, options, halfClose = true, idleTimeout = Duration.Inf)
      .map: connection =>
        val from = addressOf(connection.remoteAddress)
        Incoming(from, connection.flow.mapError(lost(from)))
      .mapError(explain)
      .mapMaterializedValue(
        _.transform(listening, explain.applyOrElse(_, identity))(using ExecutionContext.parasitic)
      )

object TcpTransport:
  private val options = List[SocketOption](SO.TcpNoDelay(true))

  private type Explain = PartialFunction[Throwable, Throwable]

  private def connectError(to: Address, timeout: Span): Explain =
    case e: StreamTcpException => e.getCause match
        case c: ConnectException if c.getMessage.startsWith("Connect timeout") =>
          TransportError.NoAnswer(to, timeout)
        case _: ConnectException                                  => TransportError.NobodyListens(to)
        case null                                                 => TransportError.Lost(to, e.getMessage)
        case c if rootCause(c).isInstanceOf[UnknownHostException] => TransportError.UnknownHost(to)
        case c                                                    => TransportError.Failed(to, c)

  private def listenError(at: Address): Explain =
    case e: BindFailedException => e.getCause match
        case c: BindException if c.getMessage.contains("already in use") => TransportError.PortTaken(at)
        case null => TransportError.CannotListen(at, e.getMessage)
        case c    => TransportError.CannotListen(at, c.getMessage)

  private def lost(from: Address): Explain =
    case e: StreamTcpException => TransportError.Lost(from, e.getMessage)

  private def rootCause(e: Throwable): Throwable =
    Iterator.iterate(e)(_.getCause).takeWhile(_ != null).toSeq.last

  private def addressOf(socket: InetSocketAddress): Address = Address(socket.getHostString, socket.getPort)

  private def listening(binding: Tcp.ServerBinding): Listening = new Listening:
    val address: Address      = addressOf(binding.localAddress)
    def close(): Future[Done] = binding.unbind().map(_ => Done)(using ExecutionContext.parasitic)
