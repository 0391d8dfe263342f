package skein.cluster

import java.nio.ByteBuffer
import javax.net.ssl.SSLEngineResult.{HandshakeStatus, Status}
import javax.net.ssl.{SSLContext, SSLEngine, SSLEngineResult, SSLException, SSLSession}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.remote.artery.tcp.SSLEngineProvider

/** An engine for connections on loopback without certificates: passes bytes through unchanged, and refuses a
  * connection whose frames have invalid lengths ([[FrameCheck]]). Pekko's transport lets only a TLS engine
  * see received bytes; this one encrypts nothing. Its handshake ends with the first call.
  */
private[cluster] final class PlainEngine(mostFrame: Int) extends SSLEngine:
  private val check     = FrameCheck(mostFrame)
  private var isGreeted = false
  private var isInOver  = false
  private var isOutOver = false
  private var client    = false
  private lazy val none = SSLContext.getDefault.createSSLEngine()

  def getHandshakeStatus: HandshakeStatus =
    if isGreeted then HandshakeStatus.NOT_HANDSHAKING else HandshakeStatus.NEED_WRAP

  def wrap(sources: Array[ByteBuffer], from: Int, count: Int, into: ByteBuffer): SSLEngineResult =
    if isOutOver then
      isGreeted = true
      SSLEngineResult(Status.CLOSED, HandshakeStatus.NOT_HANDSHAKING, 0, 0)
    else if !isGreeted then
      isGreeted = true
      SSLEngineResult(Status.OK, HandshakeStatus.FINISHED, 0, 0)
    else
      val moved = (from until from + count).map(at => moving(sources(at), into)).sum
      SSLEngineResult(Status.OK, HandshakeStatus.NOT_HANDSHAKING, moved, moved)

  def unwrap(source: ByteBuffer, into: Array[ByteBuffer], from: Int, count: Int): SSLEngineResult =
    if isInOver then SSLEngineResult(Status.CLOSED, getHandshakeStatus, 0, 0)
    else if !source.hasRemaining then SSLEngineResult(Status.BUFFER_UNDERFLOW, getHandshakeStatus, 0, 0)
    else
      val begun = source.position()
      val moved = (from until from + count).map(at => moving(source, into(at))).sum
      val seen  = source.duplicate().position(begun).limit(begun + moved)
      for length <- check.refused(seen) do
        isInOver = true // Pekko calls once more before it ends.
        throw SSLException(s"expected a frame of $mostFrame bytes at most, got one of $length")
      val status = if moved == 0 then Status.BUFFER_OVERFLOW else Status.OK
      SSLEngineResult(status, getHandshakeStatus, moved, moved)

  private def moving(source: ByteBuffer, into: ByteBuffer): Int =
    val count = source.remaining.min(into.remaining)
    into.put(into.position(), source, source.position(), count).position(into.position() + count): Unit
    source.position(source.position() + count): Unit
    count

  def beginHandshake(): Unit                = ()
  def getDelegatedTask: Runnable            = null
  def closeInbound(): Unit                  = isInOver = true
  def isInboundDone: Boolean                = isInOver
  def closeOutbound(): Unit                 = isOutOver = true
  def isOutboundDone: Boolean               = isOutOver
  def getUseClientMode: Boolean             = client
  def setUseClientMode(mode: Boolean): Unit = client = mode

  // There is no session.
  export none.{
    getSession,
    getSupportedCipherSuites,
    getEnabledCipherSuites,
    setEnabledCipherSuites,
    getSupportedProtocols,
    getEnabledProtocols,
    setEnabledProtocols,
    setNeedClientAuth,
    getNeedClientAuth,
    setWantClientAuth,
    getWantClientAuth,
    setEnableSessionCreation,
    getEnableSessionCreation
  }

private[cluster] final class PlainEngines(system: ActorSystem) extends SSLEngineProvider:
  private val mostFrame =
    system.settings.config.getBytes("pekko.remote.artery.advanced.maximum-frame-size").toInt

  def createServerSSLEngine(hostname: String, port: Int): SSLEngine = PlainEngine(mostFrame)
  def createClientSSLEngine(hostname: String, port: Int): SSLEngine =
    val engine = PlainEngine(mostFrame)
    engine.setUseClientMode(true)
    engine
  def verifyClientSession(hostname: String, session: SSLSession): Option[Throwable] = None
  def verifyServerSession(hostname: String, session: SSLSession): Option[Throwable] = None
