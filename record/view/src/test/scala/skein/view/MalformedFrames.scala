package skein.view

import java.io.{BufferedOutputStream, IOException, InputStream}
import java.net.Socket
import java.nio.charset.StandardCharsets.US_ASCII
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Await, ExecutionContext}
import scala.util.Random
import skein.record.Samples
import skein.units.Clock

/** Writes invalid, truncated, mislabelled or meaningless frames to a server: on one connection after the
  * other, a new one when the server closes the last.
  */
private[view] final class MalformedFrames(port: Int, path: String, seed: Long):
  private val random = Random(seed)

  /** @return the number of connections that were used */
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
        // The server may close at any frame; frames that it has not read then count, too, since it had to
        // handle them.
        val burst = math.min(1 + random.nextInt(400), frames - written)
        for _ <- 1 to burst do
          written += 1
          out.write(frame())
        out.flush()
      catch case _: IOException => () // The server closed the connection.
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

/** Writes invalid or forbidden requests to a server: on one connection after the other. */
private[view] final class MalformedRequests(port: Int, seed: Long):
  private val random = Random(seed)

  /** @return the number of connections that were used */
  def write(requests: Int): Int =
    var (written, connections) = (0, 0)
    while written < requests do
      connections += 1
      val socket = Socket("127.0.0.1", port)
      try
        val out = BufferedOutputStream(socket.getOutputStream)
        // Answers are few and short; a client that reads none is disconnected by the server's limits.
        val burst = math.min(1 + random.nextInt(50), requests - written)
        for _ <- 1 to burst do
          written += 1
          out.write(request())
        out.flush()
      catch case _: IOException => () // The server closed the connection.
      finally socket.close()
    connections

  private def noise(size: Int) = { val all = new Array[Byte](size); random.nextBytes(all); all }

  private def request(): Array[Byte] =
    val host               = s"Host: 127.0.0.1:$port\r\n"
    def said(text: String) = text.getBytes(US_ASCII)
    def letters(size: Int) = Iterator.fill(size)(('!' + random.nextInt(90)).toChar).mkString
    random.nextInt(8) match
      case 0 => noise(1 + random.nextInt(60))
      case 1 => said(s"GET /${letters(1 + random.nextInt(40))} HTTP/1.1\r\n$host\r\n")
      case 2 => said(s"GET / HTTP/1.1\r\nHost: ${letters(8)}\r\n\r\n")
      case 3 => said(s"${letters(5)} / HTTP/9.9\r\n\r\n")
      case 4 => said(s"GET / HTTP/1.1\r\n$host" + s"X: ${letters(30)}\r\n" * random.nextInt(200) + "\r\n")
      case 5 => said(s"POST /hover HTTP/1.1\r\n${host}Content-Length: ${random.nextLong()}\r\n\r\n")
      case 6 => said(
          s"GET / HTTP/1.1\r\n${host}Upgrade: websocket\r\nConnection: " +
            s"Upgrade\r\nOrigin: http://${letters(6)}\r\n\r\n"
        )
      case _ => said(
          "POST /flights/stream-vpn/abort " +
            s"HTTP/1.1\r\n${host}X-Skein-Token: ${letters(16)}\r\nContent-Length: 0\r\n\r\n"
        )

/** Tests a server with malformed frames, then with as many malformed requests, and then with a thousand
  * connections that stay open, during a viewer's session: a million frames, for the documented figure.
  */
@main def bearMalformedFrames(frames: Int): Unit =
  val shows = Shows()
  val feed  = Feed()
  shows.add(LiveShow(Samples.heading, feed))
  val server =
    Await.result(ViewServer.start(shows, Clock.system, ExecutionContext.global, port = 0), 30.seconds)
  def memory = { System.gc(); (Runtime.getRuntime.totalMemory - Runtime.getRuntime.freeMemory) >> 20 }
  def told(what: String, from: Long) =
    println(
      f"$what in ${(System.nanoTime() - from) * 1e-9}%.1f s; heap $memory MiB; ${shows.all.head.watching} viewers"
    )
  println(s"heap $memory MiB before")
  val first = System.nanoTime()
  val took  = MalformedFrames(server.port, "/flights/stream-vpn", seed = 1).write(frames)
  told(f"$frames%,d frames on $took%,d connections", first)
  val second = System.nanoTime()
  val more   = MalformedRequests(server.port, seed = 2).write(frames)
  told(f"$frames%,d requests on $more%,d connections", second)
  val third   = System.nanoTime()
  val sockets = Vector.fill(1000)(Socket("127.0.0.1", server.port))
  // All but the greatest allowed number see their end.
  val ended = sockets.drop(ViewerLimits().connections).count(socket =>
    scala.util.Try(socket.getInputStream.read()).getOrElse(-1) == -1
  )
  told(s"1,000 connections, of which $ended were closed at once,", third)
  sockets.foreach(_.close())
  // A valid viewer is served nevertheless.
  val answer = java.net.http.HttpClient.newHttpClient().send(
    java.net.http.HttpRequest.newBuilder(java.net.URI.create(s"${server.url}/flights")).build(),
    java.net.http.HttpResponse.BodyHandlers.ofString
  )
  println(s"then: ${answer.statusCode} ${answer.body}")
  Await.result(server.close(), 30.seconds): Unit
