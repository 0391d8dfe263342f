package skein.view

import java.io.{BufferedOutputStream, IOException, InputStream}
import java.net.Socket
import java.nio.charset.StandardCharsets.US_ASCII
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Await, ExecutionContext}
import scala.util.Random
import skein.record.Samples
import skein.units.Clock

/** Writes frames to a server that are none, are cut off, claim what they are not, or say nothing of the protocol: on one
  * connection after the other, a new one where the server ends the last.
  */
private[view] final class MalformedFrames(port: Int, path: String, seed: Long):
  private val random = Random(seed)

  /** @return
    *   connections that it took
    */
  def write(frames: Int): Int =
    var (written, connections) = (0, 0)
    while written < frames do
      connections += 1
      val socket = Socket("127.0.0.1", port)
      try
        val out = BufferedOutputStream(socket.getOutputStream)
        out.write(request.getBytes(US_ASCII))
        out.flush()
        handshake(socket.getInputStream)
        // The server may close at any of them: what it has not read then counts, too, for it had to be dealt with.
        val burst = math.min(1 + random.nextInt(400), frames - written)
        for _ <- 1 to burst do
          written += 1
          out.write(frame())
        out.flush()
      catch case _: IOException => () // It was turned out.
      finally socket.close()
    connections

  private def request =
    s"GET $path HTTP/1.1\r\nHost: 127.0.0.1:$port\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" +
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n" +
      s"Sec-WebSocket-Protocol: ${Protocol.Names.head}\r\n\r\n"

  private def handshake(in: InputStream): Unit =
    val end  = "\r\n\r\n"
    var last = ""
    while last != end do
      val next = in.read()
      if next < 0 then throw IOException("it ended before it began")
      last = (last + next.toChar).takeRight(4)

  private def bytes(size: Int) = { val all = new Array[Byte](size); random.nextBytes(all); all }

  private def frame(): Array[Byte] = random.nextInt(8) match
    case 0 => bytes(1 + random.nextInt(40))            // no frame at all
    case 1 => masked(0x81, bytes(random.nextInt(120))) // text that is none
    case 2 => masked(0x82, bytes(random.nextInt(120))) // binary without a meaning
    case 3 => masked(0x81, """{"op":"subscribe","subscriptions":[{"id":-1}]}""".getBytes) // wrong fields
    case 4 => masked(0x81, ("[" * random.nextInt(120)).getBytes)                          // nested and open
    case 5 => Array(0x82.toByte, 0xff.toByte) ++ bytes(8)                   // a length of any size
    case 6 => Array(0x81.toByte, 5.toByte) ++ "plain".getBytes              // not masked, as clients must
    case _ => masked(0x80 | random.nextInt(16), bytes(random.nextInt(120))) // any kind of frame

  private def masked(first: Int, payload: Array[Byte]): Array[Byte] =
    val mask = bytes(4)
    Array(first.toByte, (0x80 | payload.length).toByte) ++ mask ++
      payload.zipWithIndex.map((byte, at) => (byte ^ mask(at % 4)).toByte)

/** How a server bears as many malformed frames as are named: a million, for the figure. */
@main def bearMalformedFrames(frames: Int): Unit =
  val shows = Shows()
  val feed  = Feed()
  shows.add(LiveShow(Samples.heading, feed))
  val server =
    Await.result(ViewServer.start(shows, Clock.system, ExecutionContext.global, port = 0), 30.seconds)
  def memory = { System.gc(); (Runtime.getRuntime.totalMemory - Runtime.getRuntime.freeMemory) >> 20 }
  val before = memory
  val from   = System.nanoTime()
  val took   = MalformedFrames(server.port, "/flights/stream-vpn", seed = 1).write(frames)
  val spent  = (System.nanoTime() - from) * 1e-9
  println(
    f"$frames%,d frames on $took%,d connections in $spent%.1f s; ${server.counts.refusedMessages}%,d messages refused, " +
      f"${server.counts.refusedConnections}%,d connections; heap $before MiB before, $memory MiB after; " +
      s"${shows.all.head.watching} viewers are left"
  )
  Await.result(server.close(), 30.seconds): Unit
