package skein.link

import java.io.IOException
import java.net.{InetSocketAddress, Socket}
import java.nio.ByteBuffer
import javax.net.ssl.SSLContext
import scala.util.Using
import skein.units.Span

/** Whether who listens somewhere speaks TLS. */
private[skein] object TlsProbe:
  // RFC 8446, 5.1: a record's type, which is an alert or of a handshake, and the version's first byte.
  private val Alert     = 21
  private val Handshake = 22
  private val Version   = 3

  /** To connect, and so long again for an answer, where a person waits for what is wrong. */
  val Within: Span = Span.ofSeconds(2)

  /** Greets by TLS, and sees whether the answer is TLS too, whatever it says. Blocks for `within` to connect,
    * and so long again for the answer.
    */
  def answers(at: Address, within: Span = Within): Boolean =
    try
      Using.resource(Socket()): socket =>
        val millis = within.toMillis.toInt
        socket.connect(InetSocketAddress(at.host, at.port), millis)
        socket.setSoTimeout(millis)
        socket.getOutputStream.write(greeting)
        val answer = socket.getInputStream.readNBytes(2)
        answer.length == 2 && (answer(0) == Alert || answer(0) == Handshake) && answer(1) == Version
    catch case _: IOException => false

  private def greeting: Array[Byte] =
    val engine = SSLContext.getDefault.createSSLEngine()
    engine.setUseClientMode(true)
    val into = ByteBuffer.allocate(engine.getSession.getPacketBufferSize)
    engine.wrap(ByteBuffer.allocate(0), into)
    into.array.take(into.position())
