package skein.link

import java.io.IOException
import java.net.{InetSocketAddress, Socket, SocketException, SocketTimeoutException}
import java.nio.ByteBuffer
import javax.net.ssl.SSLContext
import scala.util.Using
import skein.units.Span

/** Determines whether the listener at an address speaks TLS. */
private[skein] object TlsProbe:
  // RFC 8446, 5.1: a record's type, which is an alert or of a handshake, and the version's first byte.
  private val Alert     = 21
  private val Handshake = 22
  private val Version   = 3

  /** Time limit of connecting, and of waiting for the answer: short, since the user waits for the result. */
  val Within: Span = Span.ofSeconds(2)

  /** Sends a TLS ClientHello, and returns whether the answer is TLS, whatever its content. Blocks for at most
    * `within` to connect, and for at most `within` again for the answer.
    */
  def answers(at: Address, within: Span = Within): Boolean =
    tried(at, within)(greeted).exists: answer =>
      answer.length == 2 && (answer(0) == Alert || answer(0) == Handshake) && answer(1) == Version

  /** Whether the listener closes a connection that begins with TLS, but not one that sends nothing, as a
    * server of another protocol does. A link whose far side is down closes both, or none. Blocks for at most
    * three times `within`.
    */
  def isRefused(at: Address, within: Span = Within): Boolean =
    tried(at, within)(greeted).exists(_.isEmpty) && tried(at, within): socket =>
      try socket.getInputStream.read() >= 0
      catch case _: SocketTimeoutException => true
    .contains(true)

  private def greeted(socket: Socket): Array[Byte] =
    socket.getOutputStream.write(greeting)
    try socket.getInputStream.readNBytes(2)
    // The peer may close it before it has read everything.
    catch case _: SocketException => Array.emptyByteArray

  private def tried[A](at: Address, within: Span)(ask: Socket => A): Option[A] =
    try
      Using.resource(Socket()): socket =>
        val millis = within.toMillis.toInt
        socket.connect(InetSocketAddress(at.host, at.port), millis)
        socket.setSoTimeout(millis)
        Some(ask(socket))
    catch case _: IOException => None

  private def greeting: Array[Byte] =
    val engine = SSLContext.getDefault.createSSLEngine()
    engine.setUseClientMode(true)
    val into = ByteBuffer.allocate(engine.getSession.getPacketBufferSize)
    engine.wrap(ByteBuffer.allocate(0), into)
    into.array.take(into.position())
