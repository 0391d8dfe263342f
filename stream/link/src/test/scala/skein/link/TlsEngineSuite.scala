package skein.link

import java.nio.ByteBuffer
import javax.net.ssl.SSLEngineResult.{HandshakeStatus, Status}
import javax.net.ssl.{SSLContext, SSLEngine, SSLException}

class TlsEngineSuite extends munit.FunSuite:
  private def engine(asClient: Boolean): SSLEngine =
    val made = SSLContext.getDefault.createSSLEngine("lab", 1)
    made.setUseClientMode(asClient)
    TlsEngine(made)

  private val into = ByteBuffer.allocate(1 << 15)

  private val lies = Seq[(String, Array[Byte])](
    "a record of 32 KiB"                  -> Array[Byte](22, 3, 1, 127, -1),
    "one byte more than a record has"     -> Array[Byte](23, 3, 3, 65, 1),
    "the format of before TLS, of 32 KiB" -> Array[Byte](-1, -1, 1, 3, 1),
    "a type that is none"                 -> Array[Byte](24, 3, 3, 0, 2),
    "a single byte of noise"              -> Array[Byte](-128)
  )

  for (name, bytes) <- lies do
    test(s"an invalid record is refused immediately, without waiting for more: $name"):
      val server = engine(asClient = false)
      server.beginHandshake()
      intercept[SSLException](server.unwrap(ByteBuffer.wrap(bytes), into)): Unit
      assertEquals(server.unwrap(ByteBuffer.wrap(bytes), into).getStatus, Status.CLOSED)

  test("a ClientHello passes in any segmentation"):
    val (client, server) = (engine(asClient = true), engine(asClient = false))
    client.beginHandshake()
    val greeting = ByteBuffer.allocate(1 << 15)
    assertEquals(client.wrap(ByteBuffer.allocate(0), greeting).getStatus, Status.OK)
    greeting.flip(): Unit
    for size <- 0 until greeting.limit() do
      val piece = greeting.duplicate().limit(size)
      assertEquals(server.unwrap(piece, into).getStatus, Status.BUFFER_UNDERFLOW)
    val result = server.unwrap(greeting, into)
    assertEquals((result.getStatus, result.getHandshakeStatus), (Status.OK, HandshakeStatus.NEED_TASK))

  test("verification of names is configured on the JDK's engine"):
    val own        = SSLContext.getDefault.createSSLEngine("lab", 1)
    val parameters = own.getSSLParameters
    parameters.setEndpointIdentificationAlgorithm("HTTPS")
    own.setSSLParameters(parameters)
    val engine = TlsEngine(own)
    assertEquals(engine.getSSLParameters.getEndpointIdentificationAlgorithm, "HTTPS")
    engine.setSSLParameters(engine.getSSLParameters)
    assertEquals(own.getSSLParameters.getEndpointIdentificationAlgorithm, "HTTPS")
    assertEquals((engine.getPeerHost, engine.getPeerPort), ("lab", 1))

  test("all other settings are those of the JDK's engine"):
    val own    = SSLContext.getDefault.createSSLEngine("lab", 1)
    val engine = TlsEngine(own)
    def told   = (of: SSLEngine) =>
      (
        (of.getUseClientMode, of.getNeedClientAuth, of.getWantClientAuth, of.getEnableSessionCreation),
        (of.getEnabledProtocols.toSeq, of.getEnabledCipherSuites.toSeq),
        (of.getSupportedProtocols.toSeq, of.getSupportedCipherSuites.toSeq),
        (of.isInboundDone, of.isOutboundDone, of.getHandshakeStatus)
      )
    engine.setEnabledProtocols(Array("TLSv1.3"))
    engine.setEnabledCipherSuites(Array("TLS_AES_128_GCM_SHA256"))
    assertEquals(own.getEnabledCipherSuites.toSeq, Seq("TLS_AES_128_GCM_SHA256"))
    assertEquals(own.getEnabledProtocols.toSeq, Seq("TLSv1.3"))
    for is <- Seq(true, false) do
      engine.setUseClientMode(is)
      assertEquals(own.getUseClientMode, is)
      engine.setNeedClientAuth(is)
      assertEquals(own.getNeedClientAuth, is)
      assertEquals(told(engine), told(own))
      engine.setWantClientAuth(is)
      assertEquals(own.getWantClientAuth, is)
      engine.setEnableSessionCreation(is)
      assertEquals(own.getEnableSessionCreation, is)
      assertEquals(told(engine), told(own))
    engine.closeOutbound()
    assert(own.isOutboundDone)
    assertEquals(told(engine), told(own))
