package skein.view

import java.nio.ByteOrder
import org.apache.pekko.http.scaladsl.model.ws.{BinaryMessage, TextMessage}
import skein.record.*
import skein.units.*

class ShowSuite extends munit.FunSuite:

  /** All messages that wait for a viewer. */
  private def taken(viewer: Viewer) = Vector.unfold(())(_ => viewer.take().map((_, ())))

  /** The topics of all waiting data messages, and their bytes. */
  private def came(show: Show, viewer: Viewer): Vector[(topic: String, bytes: Array[Byte])] =
    val topics = show.channels.map(channel => channel.id -> channel.topic.name).toMap
    taken(viewer)
      .collect { case BinaryMessage.Strict(bytes) if bytes(0) == 1 => bytes }
      .map: bytes =>
        (
          topics(bytes.slice(1, 5).toByteBuffer.order(ByteOrder.LITTLE_ENDIAN).getInt.toLong),
          bytes.drop(13).toArray
        )

  /** Topic and JSON of every data message that waits for a viewer. */
  private def seen(show: Show, viewer: Viewer): Vector[(topic: String, row: ujson.Value)] =
    came(show, viewer).map(one => (topic = one.topic, row = ujson.read(one.bytes)))

  /** Subscribes by the channels' own numbers. */
  private def watching(show: Show, topics: String*): Viewer =
    val viewer = Viewer(show.limits, show.channels.map(_.id).toSet, () => ())
    show.entered(viewer, at(0))
    for channel <- show.channels if topics.contains(channel.topic.name) do
      assertEquals(viewer.subscribe(channel.id, channel.id), Right(()))
      show.subscribed(viewer, channel.id, channel.id)
    viewer

  private def at(seconds: Double) = Instant.ofNanos((seconds * 1e9).toLong)

  private val heading = Samples.heading
  private val rows    = heading.records ++ (1 to 5).map(step => Samples.reading(step))
  private def replay  = RecordedShow(
    "flight",
    Vector("Pursuer", "Evader"),
    rows.zipWithIndex.map((row, at) => (at.toLong, row)).toVector
  )

  test("a running flight shows its heading to a new viewer, then every record as it is taken from the feed"):
    val feed   = Feed()
    val show   = LiveShow(heading, feed)
    val viewer = watching(show, "/skein/vehicle", "/skein/reading", "/vehicles/Pursuer/pose")
    assertEquals(seen(show, viewer).map(_.row("name").str), Vector("Pursuer", "Evader"))
    feed.offer(Samples.reading(7))
    assertEquals(seen(show, viewer), Vector.empty)
    show.turn(at(1))
    val told = seen(show, viewer)
    assertEquals(told.map(_.topic), Vector("/skein/reading", "/vehicles/Pursuer/pose"))
    assertEquals(told.head.row("sequence").num, 7.0)

  test("a late viewer sees the newest record of every vehicle"):
    val feed = Feed()
    val show = LiveShow(heading, feed)
    for step <- 1 to 3; name <- Seq("Pursuer", "Evader") do feed.offer(Samples.reading(step, name))
    show.turn(at(1))
    val told = seen(show, watching(show, "/skein/reading"))
    assertEquals(
      told.map(one => (one.row("vehicle").str, one.row("sequence").num)),
      Vector(("Pursuer", 3.0), ("Evader", 3.0))
    )

  private val image  = "/vehicles/Pursuer/front_center/image"
  private val sensor = ImagingSensor.camera("Pursuer", "front_center", "Scene")

  test("the newest of a camera's images is shown, as a JPEG, at most ten times per second"):
    val feed   = Feed()
    val show   = LiveShow(heading, feed, sensors = Vector(sensor))
    val viewer = watching(show, image, "/skein/image")
    for number <- 1 to 40 do
      feed.offer(Samples.image(number))
      show.turn(at(10) + Span.ofMillis(25) * number)
    val told = Vector.unfold(())(_ => Option(came(show, viewer)).filter(_.nonEmpty).map((_, ()))).flatten
    assertEquals(told.count(_.topic == "/skein/image"), 10)
    // The viewer took nothing meanwhile: of images only the newest waits.
    val files = told.filter(_.topic == image).map(_.bytes)
    assertEquals(files.size, 1)
    val jpeg = ImagePreviewsSuite.jpeg(files.head)
    assertEquals((jpeg.getWidth, jpeg.getHeight), (40, 30))

  test("a channel of images states that its messages are Protocol Buffers, with their descriptors"):
    val show     = LiveShow(heading, Feed(), sensors = Vector(sensor))
    val channels = ujson.read(Protocol.advertise(show.channels))("channels").arr
    val camera   = channels.find(_("topic").str == image).get
    assertEquals(
      (camera("encoding").str, camera("schemaEncoding").str, camera("schemaName").str),
      ("protobuf", "protobuf", "foxglove.CompressedImage")
    )
    assert(java.util.Base64.getDecoder.decode(camera("schema").str).length > 100)
    assertEquals(channels.find(_("topic").str == "/scene").get("encoding").str, "json")

  test("a seek over many images of a recording shows only the newest image before its target"):
    val filmed =
      heading.records ++ (1 to 30).flatMap(step => Seq(Samples.reading(step), Samples.image(step * 3)))
    val show   = RecordedShow.of(filmed.zipWithIndex.map((row, at) => (at.toLong, row)).toVector)
    val viewer = watching(show, "/skein/image")
    came(show, viewer): Unit
    val Some((a, _)) = show.recorded: @unchecked
    show.control(ClientMessage.Playback(playing = false, 1, Some(a + Span.ofMillis(1000)), ""), at(1)): Unit
    assertEquals(seen(show, viewer).map(_.row("sequence").num), Vector(33.0))

  /** The times that the server has sent to the viewer, s, in order. */
  private def clock(viewer: Viewer): Vector[Double] = taken(viewer)
    .collect {
      case BinaryMessage.Strict(bytes) if bytes(0) == 2 =>
        bytes.drop(1).toByteBuffer.order(ByteOrder.LITTLE_ENDIAN).getLong * 1e-9
    }

  test("a flight's time begins with its first reading, and later viewers receive that"):
    val feed  = Feed()
    val show  = LiveShow(heading, feed)
    val early = watching(show, "/skein/clock")
    show.turn(at(3))
    assertEquals(seen(show, early), Vector.empty)
    feed.offer(Samples.reading(4))
    feed.offer(Samples.reading(5))
    show.turn(at(4))
    val begun = Samples.reading(4).state.sentAt.toNanos.toString
    for viewer <- Seq(early, watching(show, "/skein/clock")) do
      assertEquals(seen(show, viewer).map(_.row("startedAtNs").str), Vector(begun))

  test("when a flight has ended its time stops, and nothing more of it is shown"):
    val feed  = Feed()
    var asked = 0
    val gauge =
      Gauge(Topic("/skein/graph", "skein.graph", "{}"), Span.ofMillis(500), () => { asked += 1; Some("{}") })
    val show   = LiveShow(heading, feed, Vector(gauge))
    val viewer = watching(show, "/skein/reading", "/skein/ending")
    show.turn(at(10))
    feed.offer(Ending(at(10.1), EndingKind.Completed, None))
    show.turn(at(10.2))
    feed.offer(Samples.reading(9))
    show.turn(at(20))
    show.turn(at(30))
    assertEquals(asked, 2)
    val came = taken(viewer)
    assert(came.exists { case BinaryMessage.Strict(bytes) => bytes(0) == 2; case _ => false })
    val late = watching(show, "/skein/reading", "/skein/ending")
    show.turn(at(40))
    assertEquals(clock(late).map(seconds => (seconds * 10).round), Vector(101L))
    assertEquals(
      seen(show, watching(show, "/skein/reading", "/skein/ending")).map(_.topic),
      Vector("/skein/ending")
    )

  test("a gauge is computed no more often than its interval"):
    var asked = 0
    val gauge =
      Gauge(Topic("/skein/graph", "skein.graph", "{}"), Span.ofMillis(500), () => { asked += 1; Some("{}") })
    val show = LiveShow(heading, Feed(), Vector(gauge))
    for turn <- 0 to 40 do show.turn(at(10) + Span.ofMillis(25) * turn)
    assertEquals(asked, 3)

  test("a failing turn is reported, and the next one follows"):
    var asked   = 0
    def graph() =
      asked += 1
      if asked == 1 then throw IllegalStateException("no graph yet") else Some("{}")
    val gauge  = Gauge(Topic("/skein/graph", "skein.graph", "{}"), Span.ofMillis(500), graph)
    val show   = LiveShow(heading, Feed(), Vector(gauge))
    val viewer = watching(show, "/skein/graph")
    show.attempt(at(10))
    val told = taken(viewer).collect { case TextMessage.Strict(text) =>
      text
    }
    assert(told.exists(_.contains("no graph yet")), told.toString)
    show.attempt(at(11))
    assertEquals(seen(show, viewer).map(_.topic), Vector("/skein/graph"))

  test("a recording is stopped at its start, plays at its speed, and ends"):
    val show   = replay
    val viewer = watching(show, "/skein/reading")
    assertEquals(seen(show, viewer).map(_.row("sequence").num), Vector(1.0))
    show.turn(at(1))
    assertEquals(seen(show, viewer), Vector.empty)
    assertEquals(show.control(ClientMessage.Playback(playing = true, 2, None, ""), at(1)), Right(()))
    show.turn(at(1.11))
    assertEquals(seen(show, viewer).map(_.row("sequence").num), Vector(2.0, 3.0))
    show.turn(at(9))
    assertEquals(seen(show, viewer).map(_.row("sequence").num), Vector(4.0, 5.0))

  test("a viewer that connects during or after playback receives its present state"):
    val show         = replay
    val Some((a, b)) = show.recorded: @unchecked
    show.control(ClientMessage.Playback(playing = true, 1, None, ""), at(1)): Unit
    def greeting(now: Instant) =
      val viewer = Viewer(show.limits, Set.empty, () => ())
      show.entered(viewer, now)
      taken(viewer).last
    def playing(status: Protocol.Status, position: Instant) =
      BinaryMessage.Strict(Protocol.playbackState(Protocol.Playing(status, position, 1, seeked = false, "")))
    assertEquals(greeting(at(1.1)), playing(Protocol.Status.Playing, a + Span.ofMillis(100)))
    assertEquals(greeting(at(9)), playing(Protocol.Status.Ended, b))

  test("after a seek backwards earlier rows are shown again, and later ones can be played again"):
    val show         = replay
    val Some((a, b)) = show.recorded: @unchecked
    val viewer       = watching(show, "/skein/reading")
    show.control(ClientMessage.Playback(playing = false, 1, Some(b), ""), at(1)): Unit
    assertEquals(seen(show, viewer).map(_.row("sequence").num), Vector(1.0, 2, 3, 4, 5))
    show.control(ClientMessage.Playback(playing = false, 1, Some(a + Span.ofMillis(150)), ""), at(1)): Unit
    assertEquals(seen(show, viewer).map(_.row("sequence").num), Vector(1.0, 2))

  test("a seek over a whole flight shows all its rows, and a seek backwards only those before it"):
    val show = RecordedShow.of(
      (heading.records ++ (1 to 2000).map(Samples.reading(_))).zipWithIndex.map((row, at) =>
        (at.toLong, row)
      ).toVector
    )
    val Some((a, b)) = show.recorded: @unchecked
    val viewer       = watching(show, "/skein/reading", "/vehicles/Pursuer/pose")
    show.control(ClientMessage.Playback(playing = false, 1, Some(b), ""), at(1)): Unit
    val readings = seen(show, viewer).filter(_.topic == "/skein/reading").map(_.row("sequence").num)
    assertEquals((readings.size, viewer.lost), (2000, 0L))
    show.control(ClientMessage.Playback(playing = false, 1, Some(a), ""), at(1)): Unit
    show.control(ClientMessage.Playback(playing = false, 1, Some(b), ""), at(1)): Unit
    show.control(ClientMessage.Playback(playing = false, 1, Some(a), ""), at(1)): Unit
    assertEquals(
      seen(show, viewer).filter(_.topic == "/skein/reading").map(_.row("sequence").num),
      Vector(1.0)
    )

  test("after a seek backwards the first row is shown again too"):
    val show         = replay
    val Some((a, b)) = show.recorded: @unchecked
    val viewer       = watching(show, "/skein/flight")
    show.control(ClientMessage.Playback(playing = false, 1, Some(b), ""), at(1)): Unit
    assertEquals(seen(show, viewer).size, 1)
    show.control(ClientMessage.Playback(playing = false, 1, Some(a), ""), at(1)): Unit
    assertEquals(seen(show, viewer).size, 1)

  test("no loss is reported for a running flight whose records were all shown"):
    val show   = LiveShow(heading, Feed())
    val viewer = watching(show)
    show.turn(at(1))
    val told = taken(viewer).collect { case TextMessage.Strict(text) =>
      text
    }
    assert(!told.exists(_.contains("too many to be shown")), told)

  test("the answer to a seek names the request and the time"):
    val show         = replay
    val Some((a, _)) = show.recorded: @unchecked
    val viewer       = watching(show)
    taken(viewer): Unit
    show.control(ClientMessage.Playback(playing = false, 1, Some(a + Span.ofMillis(150)), "me"), at(1)): Unit
    val expected = Protocol.Playing(Protocol.Status.Paused, a + Span.ofMillis(150), 1, seeked = true, "me")
    assertEquals(viewer.take(), Some(BinaryMessage.Strict(Protocol.playbackState(expected))))

  test("a slow viewer receives the notice of a seek before later rows"):
    val show         = replay
    val Some((a, _)) = show.recorded: @unchecked
    val to           = a + Span.ofMillis(150)
    val viewer       = watching(show, "/skein/reading")
    seen(show, viewer): Unit
    show.control(ClientMessage.Playback(playing = true, 1, Some(a + Span.ofMillis(300)), "on"), at(1)): Unit
    taken(viewer): Unit
    show.turn(at(1))
    show.control(ClientMessage.Playback(playing = false, 1, Some(to), "back"), at(1)): Unit
    show.control(ClientMessage.Playback(playing = true, 1, None, "play"), at(1)): Unit
    show.turn(at(1))
    def playing(status: Protocol.Status, seeked: Boolean, request: String) =
      Protocol.playbackState(Protocol.Playing(status, to, 1, seeked, request))
    val told =
      taken(viewer).collect { case BinaryMessage.Strict(bytes) => bytes }
    assertEquals(
      told.take(3),
      Vector(
        playing(Protocol.Status.Paused, seeked = true, "back"),
        playing(Protocol.Status.Playing, seeked = false, "play"),
        Protocol.timeIs(to)
      )
    )
    assertEquals(told.size, 5, "and two readings")

  test(
    "a viewer that takes nothing loses the oldest messages, and receives their number when it reads again"
  ):
    val feed   = Feed()
    val show   = LiveShow(heading, feed, limits = ViewerLimits(waiting = 10))
    val viewer = watching(show, "/skein/reading")
    for step <- 1 to 30 do feed.offer(Samples.reading(step))
    show.turn(at(1))
    val Some(TextMessage.Strict(told)) = viewer.take(): @unchecked
    assert(told.contains("20 older messages are not shown"), told)
    assertEquals(seen(show, viewer).map(_.row("sequence").num), (21 to 30).map(_.toDouble).toVector)
