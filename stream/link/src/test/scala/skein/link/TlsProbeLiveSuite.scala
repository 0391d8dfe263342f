package skein.link

import java.io.IOException
import java.net.{InetAddress, ServerSocket}
import java.util.concurrent.FutureTask
import scala.util.Using
import skein.testing.Unhurried
import skein.units.Span

/** Probes real sockets on loopback. */
class TlsProbeLiveSuite extends munit.FunSuite, Unhurried:

  /** Probes a server that reads a little and then sends this answer. */
  private def asked(answer: Int*): Boolean =
    Using.resource(ServerSocket(0, 1, InetAddress.getLoopbackAddress)): server =>
      val heard = FutureTask: () =>
        Using.resource(server.accept()): socket =>
          val first = socket.getInputStream.read()
          socket.getOutputStream.write(answer.map(_.toByte).toArray)
          first
      Thread.ofPlatform().daemon().start(heard): Unit
      val told = TlsProbe.answers(Address("127.0.0.1", server.getLocalPort), Span.ofSeconds(20))
      assertEquals(heard.get(), 22, "a handshake is begun")
      told

  test("a peer that continues the handshake, or refuses it, speaks TLS"):
    assert(asked(22, 3, 3, 0, 2, 0, 0))
    assert(asked(21, 3, 3, 0, 2, 2, 70))

  /** Probes a server that closes connections, and optionally waits for their first bytes. */
  private def refused(waits: Boolean): Boolean =
    Using.resource(ServerSocket(0, 1, InetAddress.getLoopbackAddress)): server =>
      Thread.ofPlatform().daemon().start: () =>
        try
          while true do
            Using.resource(server.accept()): socket =>
              if waits then socket.getInputStream.read(): Unit
        catch case _: IOException => ()
      TlsProbe.isRefused(Address("127.0.0.1", server.getLocalPort), Span.ofSeconds(1))

  test("a peer that closes after the ClientHello refuses TLS; a dead link does not"):
    assert(refused(waits = true))
    assert(!refused(waits = false))
    val free = Using.resource(ServerSocket(0))(_.getLocalPort)
    assert(!TlsProbe.isRefused(Address("127.0.0.1", free), Span.ofSeconds(1)))

  test("a silent peer, a peer of another protocol and a missing peer do not speak TLS"):
    assert(!asked())
    assert(!asked(22))
    assert(!asked(0, 0, 0, 4, 1))
    assert(!asked(22, 9, 9))
    val free = Using.resource(ServerSocket(0))(_.getLocalPort)
    assert(!TlsProbe.answers(Address("127.0.0.1", free), Span.ofSeconds(20)))
