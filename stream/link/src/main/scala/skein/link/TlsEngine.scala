package skein.link

import java.nio.ByteBuffer
import javax.net.ssl.{SSLEngine, SSLEngineResult, SSLException, SSLParameters, SSLSession}

/** A TLS engine that checks each record's header before the JDK's engine reads it. The JDK's engine waits for
  * a whole record of any stated length, up to 32 KiB in a format older than TLS. Pekko has room for 18 KiB,
  * and so would retry for ever.
  *
  * @param failed called with the reason why a connection is not trusted
  */
private[skein] final class TlsEngine(own: SSLEngine, failed: SSLException => Unit = _ => ())
    extends SSLEngine:
  import TlsEngine.*

  /** @param source bytes that begin with a record, since a call consumes whole records */
  def unwrap(source: ByteBuffer, into: Array[ByteBuffer], from: Int, count: Int): SSLEngineResult =
    // The JDK's engine refuses anything but a record by itself, once, and is closed then.
    telling(own.unwrap(if isRecord(source) then source else NoRecord.duplicate(), into, from, count))

  def wrap(sources: Array[ByteBuffer], from: Int, count: Int, into: ByteBuffer): SSLEngineResult =
    telling(own.wrap(sources, from, count, into))

  private def telling(step: => SSLEngineResult): SSLEngineResult =
    try step
    catch
      case error: SSLException =>
        failed(error)
        throw error

  private def isRecord(source: ByteBuffer): Boolean =
    def u8(index: Int) = source.get(source.position() + index) & 0xff
    val isOfKnownType  = source.remaining < 1 || Types.contains(u8(0))
    val fits           = source.remaining < Header || (u8(3) << 8 | u8(4)) <= Most
    isOfKnownType && fits

  // An engine that does not forward these would not verify names.
  override def getSSLParameters: SSLParameters                   = own.getSSLParameters
  override def setSSLParameters(parameters: SSLParameters): Unit = own.setSSLParameters(parameters)
  override def getPeerHost: String                               = own.getPeerHost
  override def getPeerPort: Int                                  = own.getPeerPort
  override def getHandshakeSession: SSLSession                   = own.getHandshakeSession

  export own.{
    getDelegatedTask,
    closeInbound,
    isInboundDone,
    closeOutbound,
    isOutboundDone,
    getSupportedCipherSuites,
    getEnabledCipherSuites,
    setEnabledCipherSuites,
    getSupportedProtocols,
    getEnabledProtocols,
    setEnabledProtocols,
    getSession,
    beginHandshake,
    getHandshakeStatus,
    setUseClientMode,
    getUseClientMode,
    setNeedClientAuth,
    getNeedClientAuth,
    setWantClientAuth,
    getWantClientAuth,
    setEnableSessionCreation,
    getEnableSessionCreation
  }

private[skein] object TlsEngine:
  /** Record types from `change_cipher_spec` to `application_data`: RFC 8446, 5.1. */
  private val Types = 20 to 23

  private val Header = 5

  private val NoRecord = ByteBuffer.wrap("no record".getBytes("US-ASCII"))

  /** Maximum length of an encrypted record: RFC 8446, 5.2. */
  private val Most = (1 << 14) + 256
