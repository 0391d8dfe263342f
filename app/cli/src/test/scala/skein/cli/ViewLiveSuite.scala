package skein.cli

import java.io.ByteArrayOutputStream
import java.net.URI
import java.net.http.HttpResponse.BodyHandlers
import java.net.http.{HttpClient, HttpRequest}
import java.nio.file.Path
import java.util.concurrent.Executors
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Await, ExecutionContext, Future}
import scala.util.Using
import skein.record.*
import skein.report.PaperReport
import skein.scenario.Scenarios
import skein.testing.{Lengthy, TemporaryFolders, Waiting}
import skein.units.Clock
import skein.view.{Feed, FlightControl, LiveShow, RecordedShow, Shows, Token, ViewServer}

/** Flights that are viewed while they run: by Foxglove's own client, and in a browser. */
class ViewLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy, Waiting:
  import ViewLiveSuite.*
  private given Scenarios = PaperReport.scenarios

  private def needed[A](tool: Either[String, A]): A =
    tool.left.foreach(why => assume(false, why))
    tool.toOption.get

  private def browse(url: String, token: String, steps: ujson.Value*): ujson.Value =
    val task = ujson.Obj("token" -> token, "steps" -> ujson.Arr(steps*)).render()
    val said = JavaScriptTools.run(
      240,
      "node",
      JavaScriptTools.script("browser.mjs"),
      needed(JavaScriptTools.packages).toString,
      needed(JavaScriptTools.browser),
      url,
      task
    )
    val seen = ujson.read(said.fold(fail(_), identity))
    assertEquals((seen("problems"), seen("foreign")), (ujson.Arr(), ujson.Arr()))
    seen

  private def step(what: String, how: ujson.Value*): ujson.Value = ujson.Arr((ujson.Str(what) +: how)*)

  folder.test("Foxglove's client subscribes to every topic, and every message fits its topic's schema"):
    out =>
      val packages = needed(JavaScriptTools.packages)
      val flying   = Flying.start(out, Flown*)
      val saids    = Seq("foxglove.sdk.v1", "foxglove.websocket.v1").map: protocol =>
        protocol -> Future(
          JavaScriptTools.run(
            240,
            Seq(
              "node",
              JavaScriptTools.script("client.mjs"),
              packages.toString,
              s"ws://127.0.0.1:${flying.port}/flights/predictive-vpn",
              protocol,
              SeenReadings.toString
            ) ++ SeenTopics*
          )
        )(using threads)
      val told   = saids.map((protocol, said) => protocol -> Await.result(said, 4.minutes))
      val topics = FlightTopics.all(Vehicles).map(_.name).toSet ++ Sights ++ Set(
        "/skein/graph",
        "/skein/clock",
        "/skein/scenario"
      )
      val seens = told.map((protocol, said) => protocol -> ujson.read(said.fold(fail(_), identity)))
      // Checked before the flight is ended: it has ended by itself if something never arrived.
      for (protocol, seen) <- seens do
        assertEquals((seen("protocol").str, seen("wrong")), (protocol, ujson.Arr()))
        val counts = seen("topics").arr.map(topic => topic("name").str -> topic("messages").num.toInt).toMap
        for topic <- SeenTopics do assert(counts.getOrElse(topic, 0) > 0, s"$topic: $counts")
        assertEquals(counts.keySet, topics)
      flying.abort("predictive-vpn")
      flying.land()
      val recorded =
        RecordingReader.read(out.resolve("predictive-vpn.duckdb")).fold(
          error => fail(error.message),
          identity
        )
      val places = recorded.readings.map(row => (row.vehicle, row.sequence) -> row.state).toMap
      for (_, seen) <- seens do
        val readings = seen("readings").arr
        assert(readings.size >= SeenReadings, readings.size.toString)
        for read <- readings do
          val state = places((read(0).str, read(1).num.toLong))
          assertEquals(
            (read(2).num, read(3).str.toLong),
            (state.value.positionNed.x, state.receivedAt.toNanos)
          )

  folder.test(
    "in a browser, a flight is shown, paused and continued, and its recording is played and sought"
  ): out =>
    val _      = (needed(JavaScriptTools.packages), needed(JavaScriptTools.browser))
    val flying = Flying.start(out, Flown*)
    val shown  =
      "[...skein.flight.vehicles.values()].map(one => [one.name, one.north, one.east, one.trail.length])"
    val altitude = "skein.flight.series.altitude.buckets.findLast(one => one.values[0] != null)"
    val seen     = browse(
      flying.url,
      flying.token,
      step(
        "wait",
        "window.skein?.flight?.vehicles.size === 2 && skein.flight.now > 4 && skein.frames > 10"
      ),
      step("ask", "before", shown),
      step("ask", "obstacles", "skein.flight.obstacles.length"),
      // A bucket has no altitude before its first reading.
      step("wait", s"skein.flight.own.length && skein.flight.series.own0.buckets.length && $altitude"),
      step("ask", "own", s"[skein.flight.own[0].title, $altitude.values[0]]"),
      step("wait", "skein.cameras.length === 2 && skein.cameras.every(one => one.shown > 3)"),
      step("ask", "cameras", "skein.cameras.map(one => [one.name, one.canvas.width, one.canvas.height])"),
      step(
        "ask",
        "colours",
        "skein.cameras.map(one => [...one.canvas.getContext('2d').getImageData(2, 2, 1, 1).data])"
      ),
      step("ask", "parts", "document.querySelectorAll('#graph rect').length"),
      step(
        "ask",
        "crossed",
        "[...document.querySelectorAll('#graph svg > text[paint-order] ~ path')].length"
      ),
      step("click", "#pause"),
      step("wait", "skein.flight.paused"),
      step("sleep", 1500),
      step("ask", "decided", "[...skein.flight.vehicles.values()].map(one => one.decided)"),
      step("sleep", 1500),
      step("ask", "still", "[...skein.flight.vehicles.values()].map(one => one.decided)"),
      step("click", "#continue"),
      step("wait", "!skein.flight.paused"),
      step("wait", "[...skein.flight.vehicles.values()].every(one => one.decided > skein.flight.now - 1)"),
      step("click", "#abort"),
      step("wait", "skein.flight.ending"),
      step("wait", "!skein.isConnected"),
      step("ask", "state", "document.getElementById('state').textContent"),
      step("ask", "ended", Standing),
      step("sleep", 1500),
      step("ask", "later", Standing)
    )
    flying.land()
    val file     = out.resolve("predictive-vpn.duckdb")
    val recorded = RecordingReader.read(file).fold(error => fail(error.message), identity)
    val events   = recorded.events.map(_.kind)
    assertEquals(
      events.filter(Set(EventKind.Paused, EventKind.Continued, EventKind.Aborted)),
      Vector(EventKind.Paused, EventKind.Continued, EventKind.Aborted)
    )
    assertEquals(seen("questions").arr.size, 3)
    assertEquals(seen("told")("state").str, "Stopped: it was stopped from outside")
    assertEquals(seen("told")("ended"), seen("told")("later"))
    // The page shows the flight's time, which begins with the first reading.
    val flown = recorded.ending.get.at.since(recorded.readings.map(_.state.sentAt).min).toSeconds
    assertEqualsDouble(seen("told")("ended")(0).num, flown, 0.3)
    assertEquals(seen("told")("own")(0).str, "distance, m")
    assertEqualsDouble(seen("told")("own")(1).num, 20, 10)
    // A street's objects, and its sky above what two cameras see.
    assert(seen("told")("obstacles").num >= 10, seen("told")("obstacles").toString)
    assertEquals(
      seen("told")("cameras").arr.toSet,
      Set[ujson.Value](
        ujson.Arr("Pursuer, front_center", 256, 144),
        ujson.Arr("Evader, front_center", 256, 144)
      )
    )
    for colour <- seen("told")("colours").arr do assertEquals(colour(3).num, 255.0)
    val images =
      RecordingReader.records(file).fold(error => fail(error.message), identity).map(_._2).collect:
        case image: CameraImage => image
    assertEquals(images.map(_.vehicle).toSet, Set("Pursuer", "Evader"))
    assert(images.sizeIs > 20, s"${images.size} images")
    assertEquals(seen("told")("decided"), seen("told")("still"))
    // Two of each vehicle's stages, and due, events, view, cast, steered, fan, record, feed back.
    assertEquals(seen("told")("parts").num.toInt, 18)
    assertEquals(seen("told")("crossed").num.toInt, 0, "lines above labels")
    for vehicle <- seen("told")("before").arr do
      val places = recorded.readings.filter(_.vehicle == vehicle(0).str).map(_.state.value.positionNed)
      assert(
        places.exists(place => (place.x, place.y) == (vehicle(1).num, vehicle(2).num)),
        vehicle.toString
      )
      assert(vehicle(3).num > 3)
    replayed(file, recorded)

  test("when the shown flight has ended, the page shows the next one, which can be paused"):
    val _     = (needed(JavaScriptTools.packages), needed(JavaScriptTools.browser))
    val shows = Shows()
    val clock = Clock.system
    def add(id: String)(control: FlightControl, act: Feed => Unit): Unit =
      val feed    = Feed()
      val heading = Samples.heading.copy(flight = Samples.heading.flight.copy(id = id))
      shows.add(LiveShow(heading, feed, controls = Map(control -> (() => act(feed)))))
      feed.offer(Samples.reading(1))
    add("first")(
      FlightControl.Abort,
      feed =>
        feed.offer(Ending(clock.now(), EndingKind.Stopped, None))
        add("second")(FlightControl.Pause, _.offer(Event(clock.now(), EventKind.Paused, None, "by hand")))
    )
    val token  = Token("secret")
    val server = Edge.await(ViewServer.start(shows, clock, ExecutionContext.global, port = 0, token = token))
    try
      def flies(id: String) =
        step("wait", s"window.skein?.flight?.heading?.id === '$id' && skein.flight.hasBegun")
      val seen = browse(
        server.url,
        token.word,
        flies("first"),
        step("click", "#abort"),
        flies("second"),
        step(
          "ask",
          "listed",
          "[...document.querySelectorAll('#flights option')].map(one => one.textContent)"
        ),
        step("ask", "chosen", "document.getElementById('flights').value"),
        step("click", "#pause"),
        step("wait", "skein.flight.paused")
      )
      assertEquals(seen("told")("listed"), ujson.Arr("first", "second"))
      assertEquals(seen("told")("chosen").str, "second")
    finally Edge.await(server.close()): Unit

  /** Checks that the page shows at a time exactly what the recording held by then. */
  private def replayed(file: Path, recorded: Recording): Unit =
    val shows = Shows()
    val rows  = RecordingReader.records(file).fold(error => fail(error.message), identity)
    shows.add(RecordedShow.of(rows))
    val server = Edge.await(ViewServer.start(shows, Clock.system, ExecutionContext.global, port = 0))
    try
      val shown =
        "[skein.flight.now, ...[...skein.flight.vehicles.values()].map(one => [one.name, one.north])]"
      val seen = browse(
        server.url,
        "",
        step("wait", "window.skein?.recorded && skein.flight.vehicles.size === 2"),
        step("wait", "Number(document.getElementById('seek').max) > 4"),
        step("seek", 3),
        step("wait", "Math.abs(skein.flight.now - 3) < 1e-6"),
        step("wait", "[...skein.flight.vehicles.values()].every(one => one.north !== undefined)"),
        step("sleep", 500),
        step("ask", "at3", shown),
        step("click", "#play"),
        step("wait", "skein.playing.status === 'playing' && skein.flight.now > 3.5"),
        step("click", "#play"),
        step("wait", "skein.playing.status === 'paused'"),
        step("seek", 1),
        step("wait", "Math.abs(skein.flight.now - 1) < 1e-6"),
        step("sleep", 500),
        step("ask", "at1", shown)
      )
      // The first may be an image.
      val start = rows.iterator.flatMap((_, record) => FlightTopics.knownAt(record)).next()
      for (asked, seconds) <- Seq("at3" -> 3, "at1" -> 1); vehicle <- seen("told")(asked).arr.drop(1) do
        val until  = start + skein.units.Span.ofSeconds(seconds)
        val newest =
          recorded.readings.filter(row => row.vehicle == vehicle(0).str && row.state.receivedAt <= until).last
        assertEquals(vehicle(1).num, newest.state.value.positionNed.x, s"${vehicle(0)} $asked")
    finally Edge.await(server.close()): Unit

object ViewLiveSuite:
  private val SeenReadings = 60

  /** Options for flights long enough for a busy machine to serve all viewers; the viewers end them. */
  private val Flown = Seq(
    "--loop",
    "predictive",
    "--link",
    "vpn",
    "--duration",
    "90s",
    "--scene",
    "street",
    "--images",
    "front_center@5"
  )

  private val Vehicles = Vector("Pursuer", "Evader")

  /** A script that reads what must not move once a flight has ended. */
  private val Standing =
    "[skein.flight.now, document.getElementById('time').textContent, " +
      "[...skein.flight.vehicles.values()].map(one => [one.trail.length, one.north]), " +
      "Object.values(skein.flight.series).map(one => one.buckets.length), " +
      "[...document.querySelectorAll('#plots canvas, #map canvas')].map(one => one.toDataURL().length)]"

  private val Sights = Vehicles.toSet.flatMap(name =>
    Set(s"/vehicles/$name/front_center/image", s"/vehicles/$name/front_center/calibration")
  )

  private val SeenTopics =
    Seq("reading", "decision", "command", "prediction", "acknowledgement", "graph").map("/skein/" + _) ++
      Seq(
        "/tf",
        "/tf_static",
        "/vehicles/Evader/pose",
        "/vehicles/Pursuer/trail",
        "/vehicles/Pursuer/body"
      ) ++
      Seq("/scene", "/vehicles/Pursuer/front_center/image", "/vehicles/Evader/front_center/calibration")

  /** Threads for waiting on other processes. */
  private val threads = ExecutionContext.fromExecutor(Executors.newCachedThreadPool())

  /** `./skein fly --view`, run in this process. */
  final class Flying(err: ByteArrayOutputStream, status: Future[Int]):
    private def told(what: String): String = s"$what(\\S+)".r
      .findFirstMatchIn(err.toString)
      .fold(throw IllegalStateException(s"no '$what' in: $err"))(_.group(1).stripSuffix(","))

    def url: String   = told("to be seen at ")
    def token: String = told("controls: ")
    def port: Int     = url.split(':').last.toInt

    /** Waits until viewers can find the flight. */
    def awaitStart(flight: String): Unit =
      val listed = HttpRequest.newBuilder(URI.create(s"$url/flights")).build()
      Using.resource(HttpClient.newHttpClient()): client =>
        while !status.isCompleted && !client.send(listed, BodyHandlers.ofString).body.contains(flight) do
          Thread.sleep(50)

    /** Aborts a flight as the page's button does. */
    def abort(flight: String): Unit =
      val request = HttpRequest.newBuilder(URI.create(s"$url/flights/$flight/abort"))
        .header("X-Skein-Token", token)
        .POST(HttpRequest.BodyPublishers.noBody)
        .build()
      val answer = Using.resource(HttpClient.newHttpClient())(_.send(request, BodyHandlers.ofString))
      if answer.statusCode != 200 then throw IllegalStateException(answer.body)

    /** Waits for the command's end. */
    def land(): Unit =
      val ended = Await.result(status, 3.minutes)
      if ended != 0 then throw IllegalStateException(s"it ended with $ended: $err")

  object Flying:
    def start(out: Path, options: String*)(using Scenarios): Flying =
      val err    = ByteArrayOutputStream()
      val status = Future(
        Console.withOut(ByteArrayOutputStream())(Console.withErr(err)(
          FlyCommand().run(options ++ Seq(
            "--view",
            "--view-port",
            "0",
            "--twins",
            "0",
            "--out",
            out.toString
          ))
        ))
      )(using threads)
      while !err.toString.contains("controls: ") && !status.isCompleted do Thread.sleep(50)
      Flying(err, status)
