package skein.cluster

import java.nio.ByteBuffer
import java.nio.ByteOrder.LITTLE_ENDIAN
import javax.net.ssl.SSLEngineResult
import javax.net.ssl.SSLEngineResult.{HandshakeStatus, Status}
import javax.net.ssl.SSLException

class PlainEngineSuite extends munit.FunSuite:
  private def told(result: SSLEngineResult) =
    (result.getStatus, result.getHandshakeStatus, result.bytesConsumed, result.bytesProduced)

  private val ready = HandshakeStatus.NOT_HANDSHAKING

  /** The beginning of a connection, with a frame that states this length. */
  private def connection(length: Int): ByteBuffer =
    val bytes = ByteBuffer.allocate(12).order(LITTLE_ENDIAN)
    bytes.put("AKKA".getBytes("US-ASCII")).put(1.toByte).putInt(length).put(Array[Byte](7, 8, 9)).flip()

  private def greeted(): PlainEngine =
    val engine = PlainEngine(100)
    assertEquals(engine.getHandshakeStatus, HandshakeStatus.NEED_WRAP)
    val greeting = engine.wrap(connection(3), ByteBuffer.allocate(20))
    assertEquals(told(greeting), (Status.OK, HandshakeStatus.FINISHED, 0, 0))
    assertEquals(engine.getHandshakeStatus, ready)
    engine

  test("bytes to send pass unchanged, as far as there is room"):
    val (engine, source, into) = (greeted(), connection(3), ByteBuffer.allocate(20))
    assertEquals(told(engine.wrap(source, into)), (Status.OK, ready, 12, 12))
    assertEquals(into.flip(), connection(3))
    val small = ByteBuffer.allocate(5)
    assertEquals(told(engine.wrap(connection(3), small)), (Status.OK, ready, 5, 5))

  test("received bytes pass unchanged, as far as there is room"):
    val (engine, source, into) = (greeted(), connection(3), ByteBuffer.allocate(20))
    assertEquals(told(engine.unwrap(source, into)), (Status.OK, ready, 12, 12))
    assertEquals(into.flip(), connection(3))
    assertEquals(told(engine.unwrap(source, into)), (Status.BUFFER_UNDERFLOW, ready, 0, 0))
    val full = ByteBuffer.allocate(0)
    assertEquals(told(greeted().unwrap(connection(3), full)), (Status.BUFFER_OVERFLOW, ready, 0, 0))

  test("a frame of an invalid length is an error, once, and closes only the receiving direction"):
    for length <- Seq(-1, 101) do
      val engine = greeted()
      val into   = ByteBuffer.allocate(20)
      assert(!engine.isInboundDone)
      val error = intercept[SSLException](engine.unwrap(connection(length), into))
      assertEquals(error.getMessage, s"expected a frame of 100 bytes at most, got one of $length")
      assertEquals(told(engine.unwrap(connection(3), into)), (Status.CLOSED, ready, 0, 0))
      assert(engine.isInboundDone && !engine.isOutboundDone)

  test("each direction closes by itself"):
    val engine = greeted()
    engine.closeOutbound()
    assertEquals(told(engine.wrap(connection(3), ByteBuffer.allocate(20))), (Status.CLOSED, ready, 0, 0))
    assertEquals(engine.unwrap(connection(3), ByteBuffer.allocate(20)).getStatus, Status.OK)
    engine.closeInbound()
    assert(engine.isInboundDone && engine.isOutboundDone)
    assertEquals(told(engine.unwrap(connection(3), ByteBuffer.allocate(20))), (Status.CLOSED, ready, 0, 0))

  test("the engine is in client mode once that is set"):
    val engine = PlainEngine(100)
    assert(!engine.getUseClientMode)
    engine.setUseClientMode(true)
    assert(engine.getUseClientMode)
