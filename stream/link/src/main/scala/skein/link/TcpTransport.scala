package skein.link

import java.io.IOException
import java.net.{BindException, ConnectException, InetSocketAddress, UnknownHostException}
import javax.net.ssl.{SSLContext, SSLEngine, SSLException, SSLParameters}
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.io.Inet.SocketOption
import org.apache.pekko.io.Tcp.SO
import org.apache.pekko.stream.{BindFailedException, EagerClose, StreamTcpException}
import org.apache.pekko.stream.scaladsl.{Flow, Source, Tcp}
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.Duration
import scala.concurrent.{ExecutionContext, Future}
import scala.util.Success
import skein.units.Span

/** Real sockets. Small messages are sent immediately (no Nagle).
  *
  * Without certificates each direction closes separately: a side that has finished sending still receives
  * data in transit. With them a connection is TLS 1.3, both sides present theirs, and the server's must name
  * its host; distrust of an open connection may be reported only with its first bytes, and either side's end
  * closes both directions.
  *
  * @param connectTimeout time after which an unanswered connection fails with [[TransportError.NoAnswer]]
  * @param backlog maximum number of connections that wait to be accepted; the operating system refuses more
  * @param certificates this side's certificates, and those that it trusts
  */
final class TcpTransport(
    connectTimeout: Span = Span.ofSeconds(5),
    backlog: Int = 256,
    certificates: Option[SSLContext] = None
)(using system: ActorSystem)
    extends Transport:
  import TcpTransport.*

  def connect(to: Address): Flow[ByteString, ByteString, Future[Done]] =
    val explain = connectError(to, connectTimeout)
    val at      = InetSocketAddress.createUnresolved(to.host, to.port)
    val within  = connectTimeout.toDuration
    val made    = certificates match
      case None =>
        Tcp(system).outgoingConnection(at, None, options, halfClose = true, within, Duration.Inf)
      case Some(context) =>
        Tcp(system).outgoingConnectionWithTls(
          at,
          () => connecting(context, to),
          None,
          options,
          within,
          Duration.Inf,
          _ => Success(()),
          EagerClose
        )
    made
      .mapError(explain)
      .mapMaterializedValue(
        _.transform(_ => Done, explain.applyOrElse(_, identity))(using ExecutionContext.parasitic)
      )

  def listen(at: Address): Source[Incoming, Future[Listening]] =
    val explain = listenError(at)
    val made    = certificates match
      case None =>
        Tcp(system).bind(at.host, at.port, backlog, options, halfClose = true, Duration.Inf)
      case Some(context) =>
        Tcp(system).bindWithTls(
          at.host,
          at.port,
          () => accepting(context),
          backlog,
          options,
          Duration.Inf,
          _ => Success(()),
          EagerClose
        )
    made
      .map: connection =>
        val from = addressOf(connection.remoteAddress)
        Incoming(from, connection.flow.mapError(lost(from)))
      .mapError(explain)
      .mapMaterializedValue(
        _.transform(listening, explain.applyOrElse(_, identity))(using ExecutionContext.parasitic)
      )

object TcpTransport:
  private val options = List[SocketOption](SO.TcpNoDelay(true))

  private val Protocols = Array("TLSv1.3")

  private def connecting(context: SSLContext, to: Address): SSLEngine =
    // The name is verified according to the rules of browsers.
    engine(context.createSSLEngine(to.host, to.port), isClient = true)(
      _.setEndpointIdentificationAlgorithm("HTTPS")
    )

  private def accepting(context: SSLContext): SSLEngine =
    engine(context.createSSLEngine(), isClient = false)(_.setNeedClientAuth(true))

  private def engine(made: SSLEngine, isClient: Boolean)(set: SSLParameters => Unit): SSLEngine =
    made.setUseClientMode(isClient)
    val parameters = made.getSSLParameters
    parameters.setProtocols(Protocols)
    set(parameters)
    made.setSSLParameters(parameters)
    TlsEngine(made)

  private[link] type Explain = PartialFunction[Throwable, Throwable]

  /** Converts a connection's failure to a [[TransportError]]. */
  private[link] def connectError(to: Address, timeout: Span): Explain =
    case e: StreamTcpException => e.getCause match
        case c: ConnectException if c.getMessage.startsWith("Connect timeout") =>
          TransportError.NoAnswer(to, timeout)
        case _: ConnectException                                  => TransportError.NobodyListens(to)
        case null                                                 => TransportError.Lost(to, e.getMessage)
        case c if rootCause(c).isInstanceOf[UnknownHostException] => TransportError.UnknownHost(to)
        // The peer may accept and reset before this side has seen that it is connected.
        case c: IOException if Option(c.getMessage).exists(_.startsWith("Connection reset")) =>
          TransportError.Lost(to, c.getMessage)
        case c => TransportError.Failed(to, c)
    case e: SSLException => TransportError.NotTrusted(to, e)

  private def listenError(at: Address): Explain =
    case e: BindFailedException => e.getCause match
        case c: BindException if c.getMessage.contains("already in use") => TransportError.PortTaken(at)
        case c: BindException if c.getMessage.contains("Cannot assign")  =>
          TransportError.CannotListen(at, "it is no address of this machine")
        case null => TransportError.CannotListen(at, e.getMessage)
        case c    => TransportError.CannotListen(at, c.getMessage)

  private def lost(from: Address): Explain =
    case e: StreamTcpException => TransportError.Lost(from, e.getMessage)
    case e: SSLException       => TransportError.NotTrusted(from, e)

  private def rootCause(e: Throwable): Throwable =
    Iterator.iterate(e)(_.getCause).takeWhile(_ != null).toSeq.last

  private def addressOf(socket: InetSocketAddress): Address = Address(socket.getHostString, socket.getPort)

  private def listening(binding: Tcp.ServerBinding): Listening = new Listening:
    val address: Address      = addressOf(binding.localAddress)
    def close(): Future[Done] = binding.unbind().map(_ => Done)(using ExecutionContext.parasitic)
