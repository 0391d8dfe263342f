package skein.view

import java.net.{Socket, SocketTimeoutException}
import java.nio.ByteOrder
import java.util.concurrent.ConcurrentLinkedQueue
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.http.scaladsl.Http
import org.apache.pekko.http.scaladsl.model.*
import org.apache.pekko.http.scaladsl.model.headers.{Host, Origin, RawHeader}
import org.apache.pekko.http.scaladsl.model.ws.*
import org.apache.pekko.stream.scaladsl.{Flow, Sink, SinkQueueWithCancel, Source, SourceQueueWithComplete}
import org.apache.pekko.stream.OverflowStrategy
import org.apache.pekko.util.ByteString
import scala.concurrent.{Await, ExecutionContext, Future}
import scala.concurrent.duration.*
import scala.util.Try
import skein.record.*
import skein.units.Clock

/** The server on a real socket, with Pekko's own client as a viewer. */
class ViewServerLiveSuite extends munit.FunSuite:
  private given system: ActorSystem = ActorSystem("viewers")

  override def afterAll(): Unit = await(system.terminate()): Unit

  private def await[A](future: Future[A]): A = Await.result(future, 30.seconds)

  /** @param clock measures how long connections are silent */
  private final class Served(limits: ViewerLimits, clock: Clock = Clock.system):
    val done: ConcurrentLinkedQueue[FlightControl] = ConcurrentLinkedQueue()
    val feed: Feed                                 = Feed()
    val show: LiveShow                             =
      LiveShow(
        Samples.heading,
        feed,
        limits = limits,
        controls = FlightControl.values.map(control => control -> (() => done.add(control): Unit)).toMap
      )
    val shows: Shows = Shows()
    shows.add(show)
    val server: ViewServer = await(
      ViewServer.start(
        shows,
        clock,
        ExecutionContext.global,
        port = 0,
        token = Token("right"),
        limits = limits
      )
    )

  private def serving(limits: ViewerLimits = ViewerLimits(), clock: Clock = Clock.system) =
    FunFixture[Served](_ => Served(limits, clock), served => await(served.server.close()): Unit)

  /** A clock that stays at the time that was set. */
  private final class SetClock extends Clock:
    @volatile var seconds          = 0
    def now(): skein.units.Instant = skein.units.Instant.ofNanos(seconds * 1_000_000_000L)

  private final class Connection(
      val answer: WebSocketUpgradeResponse,
      out: SourceQueueWithComplete[Message],
      in: SinkQueueWithCancel[Message]
  ):
    def send(text: String): Unit                         = await(out.offer(TextMessage(text))): Unit
    def send(bytes: ByteString): Unit                    = await(out.offer(BinaryMessage(bytes))): Unit
    def pull(): Option[Message]                          = await(in.pull())
    def until[A](wanted: PartialFunction[Message, A]): A =
      Iterator.continually(pull().getOrElse(fail("the connection ended"))).collectFirst(wanted).get
    def close(): Unit = out.complete()

  private def connect(port: Int, protocols: String*)(headers: HttpHeader*): Connection =
    val request = WebSocketRequest(s"ws://127.0.0.1:$port/flights/stream-vpn", headers).copy(subprotocol =
      Option.when(protocols.nonEmpty)(protocols.mkString(", "))
    )
    val flow = Flow.fromSinkAndSourceMat(
      Sink.queue[Message](),
      Source.queue[Message](64, OverflowStrategy.fail)
    )((_, _))
    val (answer, (in, out)) = Http().singleWebSocketRequest(request, flow)
    Connection(await(answer), out, in)

  private def text: PartialFunction[Message, ujson.Value] = { case TextMessage.Strict(text) =>
    ujson.read(text)
  }

  private def get(port: Int, path: String, headers: HttpHeader*): (Int, String, HttpResponse) =
    val response =
      await(Http().singleRequest(HttpRequest(uri = s"http://127.0.0.1:$port$path", headers = headers)))
    (response.status.intValue, await(response.entity.toStrict(10.seconds)).data.utf8String, response)

  serving().test("a client receives the topics, subscribes, and receives the flight's records"): served =>
    val client = connect(served.server.port, Protocol.Names*)()
    assertEquals(client.answer.isInstanceOf[ValidUpgrade], true)
    val info = client.until(text)
    assertEquals((info("op").str, info("capabilities").arr.map(_.str).toSeq), ("serverInfo", Seq("time")))
    val channels =
      client.until(text.andThen { case said if said("op").str == "advertise" => said("channels").arr })
    val readings = channels.find(_("topic").str == "/skein/reading").get
    assertEquals(readings("schemaEncoding").str, "jsonschema")
    client.send(s"""{"op":"subscribe","subscriptions":[{"id":77,"channelId":${readings("id").num.toInt}}]}""")
    served.feed.offer(Samples.reading(5))
    val data = client.until { case BinaryMessage.Strict(bytes) if bytes(0) == 1 => bytes }
    assertEquals(data.slice(1, 5).toByteBuffer.order(ByteOrder.LITTLE_ENDIAN).getInt, 77)
    assertEquals(ujson.read(data.drop(13).utf8String)("sequence").num, 5.0)
    client.send("""{"op":"subscribe","subscriptions":[{"id":77,"channelId":1}]}""")
    val said = client.until(text.andThen { case said if said("op").str == "status" => said("message").str })
    assertEquals(said, "there is a subscription 77 already")
    client.close()

  serving().test(
    "connections without a supported protocol, from a foreign page or by a foreign name are refused"
  ): served =>
    val port     = served.server.port
    val accepted = Seq(
      connect(port)(),
      connect(port, "foxglove.sdk.v9")(),
      connect(port, Protocol.Names*)(Origin("https://evil.example")),
      connect(port, Protocol.Names*)(Host("evil.example", port))
    ).map(_.answer.response.status.intValue)
    assertEquals(accepted, Seq(400, 400, 403, 403))
    assertEquals(get(port, "/", Host("evil.example", port))._1, 403)
    assertEquals(get(port, "/flights", Origin("http://evil.example"))._1, 403)
    assertEquals(
      connect(port, Protocol.Names.last)(Origin(s"http://localhost:$port")).answer.response.status.intValue,
      101
    )

  serving().test("the page and all its resources are served, and it refers to no other site"): served =>
    val port              = served.server.port
    val (ok, html, asked) = get(port, "/")
    assertEquals(ok, 200)
    assert(asked.headers.exists(_.is("content-security-policy")))
    val named = """(?:src|href)="([^"]+)"""".r.findAllMatchIn(html).map(_.group(1)).toVector
    val files = named ++ named.filter(_.endsWith("page.js")).flatMap(path =>
      """from "([^"]+)"""".r.findAllMatchIn(get(port, path)._2).map(_.group(1))
    )
    assert(files.size >= 8, files)
    for path <- files do
      val (status, text, _) = get(port, path)
      assertEquals((path, status), (path, 200))
      if !path.startsWith("/uplot") then
        assert(
          !text.replace("http://www.w3.org/2000/svg", "").contains("://") || path == "/connection.js",
          path
        )
    val own = files.filter(path => path.endsWith(".js") && !path.startsWith("/uplot"))
    assert(own.map(get(port, _)._2.length).sum < 60_000)
    assertEquals(
      get(port, "/flights")._2,
      """[{"id":"stream-vpn","controls":["pause","continue","abort"]}]"""
    )
    for path <- Seq("/../build.sbt", "/page.js/", "/nothing", "//etc/passwd") do
      assertEquals(get(port, path)._1, 404)

  serving(ViewerLimits(refusals =
    3
  )).test("a viewer that sends invalid messages is warned, and then disconnected; others continue"): served =>
    val other = connect(served.server.port, Protocol.Names*)()
    val bad   = connect(served.server.port, Protocol.Names*)()
    for _ <- 0 to 3 do bad.send("nonsense")
    assert(Iterator.continually(bad.pull()).takeWhile(_.isDefined).size < 1000)
    val large = connect(served.server.port, Protocol.Names*)()
    large.send(ByteString(new Array[Byte](200_000)))
    assertEquals(other.until(text)("op").str, "serverInfo")

  serving(
    ViewerLimits(connections = 5),
    SetClock()
  ).test("of two hundred silent connections each takes the place of the oldest, which is closed"): served =>
    val port    = served.server.port
    val sockets = Vector.fill(200)(Socket("127.0.0.1", port))
    // Sockets are accepted in order; a closed one sees the end of its stream, or a reset.
    for socket <- sockets.dropRight(5) do assertEquals(Try(socket.getInputStream.read()).getOrElse(-1), -1)
    sockets.foreach(_.close())

  private val standing = SetClock()

  serving(
    ViewerLimits(connections = 4),
    standing
  ).test("idle connections, also after half a request or one message, are closed to make room for new ones"):
    served =>
      import java.nio.charset.StandardCharsets.US_ASCII
      val port = served.server.port
      // A closed socket sees the end of its stream, or a reset.
      def ended(socket: Socket) = Try(socket.getInputStream.readAllBytes()).failed.toOption
        .forall(!_.isInstanceOf[SocketTimeoutException])
      def say(text: String): Socket =
        val socket = Socket("127.0.0.1", port)
        socket.setSoTimeout(20_000)
        socket.getOutputStream.write(text.getBytes(US_ASCII))
        socket
      val request = s"GET /flights HTTP/1.1\r\nHost: 127.0.0.1:$port\r\n"
      val upgrade = s"${request.replace("/flights", "/")}Upgrade: websocket\r\nConnection: Upgrade\r\n" +
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
        s"Sec-WebSocket-Protocol: ${Protocol.Names.head}\r\n\r\n"
      val silent  = say("")
      val dripped = say(request)
      // An answer has arrived, so the message was received.
      val spoken = say(upgrade)
      assertEquals(spoken.getInputStream.read(), 'H'.toInt)
      val viewer = connect(port, Protocol.Names*)()
      assertEquals(viewer.until(text)("op").str, "serverInfo")
      standing.seconds = 6
      viewer.send("""{"op":"subscribe","subscriptions":[]}""")
      viewer.send("nonsense")
      viewer.until(text.andThen { case said if said("op").str == "status" => () })
      for gone <- Seq(silent, dripped, spoken) do
        val next = say(request + "\r\n")
        assertEquals(next.getInputStream.read(), 'H'.toInt)
        assert(ended(gone))
      viewer.send("nonsense")
      viewer.until(text.andThen { case said if said("op").str == "status" => () })

  serving().test("a page of another site gets no flight, under any name"): served =>
    val port                                                              = served.server.port
    def status(origin: String, host: String = s"127.0.0.1:$port"): String =
      scala.util.Using.resource(Socket("127.0.0.1", port)): socket =>
        socket.setSoTimeout(20_000)
        socket.getOutputStream.write(
          (s"GET / HTTP/1.1\r\nHost: $host\r\nOrigin: $origin\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" +
            "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
            s"Sec-WebSocket-Protocol: ${Protocol.Names.head}\r\n\r\n").getBytes("UTF-8")
        )
        scala.io.Source.fromInputStream(socket.getInputStream, "ISO-8859-1").getLines().next().split(' ')(1)
    for from <- AccessSuite.foreign(port) do
      assert(clue(Set("403", "400"))(status(from)), from)
    assertEquals(status("http://elsewhere.example:99999"), "403")
    for host <- Seq("elsewhere.example", s"elsewhere.example:$port", s"127.0.0.1:$port.elsewhere.example", "")
    do
      assert(Set("403", "400")(status(s"http://127.0.0.1:$port", host)), host)
    assertEquals(served.show.watching, 0)
    assertEquals(status(s"http://127.0.0.1:$port"), "101")

  serving().test("a flight is paused, continued and ended only with the token"): served =>
    val port                                          = served.server.port
    def post(path: String, headers: HttpHeader*): Int =
      val request  = HttpRequest(HttpMethods.POST, s"http://127.0.0.1:$port$path", headers)
      val response = await(Http().singleRequest(request))
      response.discardEntityBytes(): Unit
      response.status.intValue
    val right = RawHeader("X-Skein-Token", "right")
    val path  = "/flights/stream-vpn/abort"
    assertEquals(post(path), 401)
    assertEquals(post(path, RawHeader("X-Skein-Token", "wrong")), 401)
    assertEquals(post(path, right, Origin("https://evil.example")), 403)
    assertEquals(post("/flights/other/abort", right), 404)
    assertEquals(post("/hover"), 401)
    assertEquals(post("/flights/stream-vpn/hover", right), 404)
    assertEquals(served.done.size, 0)
    for path <- Seq("/hover", "/flights/stream-vpn/continue", "/flights/stream-vpn/pause", path) do
      assertEquals(post(path, right, Origin(s"http://127.0.0.1:$port")), 200)
    import FlightControl.*
    assertEquals(served.done.toArray.toSeq, Seq[AnyRef](Pause, Continue, Pause, Abort))
    // A name of a link may contain reserved characters.
    val flight = Samples.heading.flight.copy(id = "stream-loss:5%/4,vpn")
    val ended  = ConcurrentLinkedQueue[FlightControl]()
    served.shows.add(LiveShow(
      Samples.heading.copy(flight = flight),
      Feed(),
      controls = Map(Abort -> (() => ended.add(Abort): Unit))
    ))
    assertEquals(post("/flights/stream-loss%3A5%25%2F4%2Cvpn/abort", right), 200)
    assertEquals(ended.size, 1)

  serving().test("thirty thousand malformed frames do not disturb another viewer"): served =>
    val seed  = 20261122L
    val other = connect(served.server.port, Protocol.Names*)()
    val took  = MalformedFrames(served.server.port, "/flights/stream-vpn", seed).write(30_000)
    assert(took > 70, s"seed $seed: $took connections")
    other.send("""{"op":"subscribe","subscriptions":[{"id":5,"channelId":4}]}""")
    val channel = served.show.channels.find(_.topic.name == "/skein/reading").get.id
    other.send(s"""{"op":"subscribe","subscriptions":[{"id":6,"channelId":$channel}]}""")
    served.feed.offer(Samples.reading(7))
    val data = other.until { case BinaryMessage.Strict(bytes) if bytes(0) == 1 && bytes(1) == 6 => bytes }
    assertEquals(ujson.read(data.drop(13).utf8String)("sequence").num, 7.0)
