package skein.cli

import com.typesafe.config.ConfigFactory
import java.nio.file.{Files, Path}
import scala.util.Using
import skein.docs.Documentation
import skein.flight.VirtualFlights
import skein.forecast.Structure
import skein.loop.LoopKind
import skein.mcap.Record as McapRecord
import skein.mcap.file.McapFile
import skein.record.{FlightTopics, MemoryRecorder, Recording, ImagingSensor}
import skein.policy.{Axis, SearchSpace}
import skein.report.PaperReport
import skein.report.SyntheticFlight
import skein.scenario.Scenarios
import skein.settings.{FlySettings, ModelFile, PredictionModel}
import skein.signal.LatencyProfile
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.Span
import skein.vehicle.ReducedModel

class RecordingCommandsSimulation extends munit.FunSuite, TemporaryFolders, Unhurried:
  private given Scenarios = PaperReport.scenarios

  private val recordings = FunFixture[Path](
    _ =>
      val folder = temporaryFolder()
      for (loop, link) <- Seq("paused" -> "none", "stream" -> "vpn") do
        write(SyntheticFlight(loop, link, seed = 1, seconds = 12), folder.resolve(s"$loop-$link.duckdb"))
      folder
    ,
    path =>
      Using.resource(Files.walk(path))(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
  )

  private def write(recording: Recording, file: Path): Unit =
    val recorder = MemoryRecorder(recording.heading)
    (recording.readings ++ recording.decisions ++ recording.commands).foreach(recorder.offer)
    assert(recorder.writeTo(file).isRight)

  /** Exit status, standard output and error output. */
  private def run(command: Command[?], arguments: String*): (Int, String, String) =
    val ran = Ran.of(command.run(arguments))
    (ran.status, ran.out, ran.err)

  recordings.test("report rebuilds page and tables from the files only"): folder =>
    val files = Seq("paused-none", "stream-vpn").map(name => folder.resolve(s"$name.duckdb").toString)
    val (status, text, err) = run(ReportCommand(), files :+ "--out" :+ folder.resolve("report").toString*)
    assertEquals((status, err), (0, ""))
    assert(text.linesIterator.exists(line => line.startsWith("stream") && line.contains("vpn")), text)
    assert(Files.exists(folder.resolve("report/report.html")))

  recordings.test(
    "a recording is not exported over itself under any name, and a folder is not a recording"
  ): folder =>
    val file   = folder.resolve("stream-vpn.duckdb")
    val before = Files.size(file)
    val linked = Files.createSymbolicLink(folder.resolve("linked.mcap"), file)
    for other <- Seq(folder.resolve("./stream-vpn.duckdb"), linked) do
      val (status, _, err) = run(ExportCommand, file.toString, "--mcap", other.toString)
      assertEquals(status, 1)
      assert(err.contains("expected another file than the recording"), err)
    assertEquals(Files.size(file), before)
    val (status, _, err) = run(ReportCommand(), "/")
    assertEquals(status, 1)
    assert(err.contains("/ is not a recording: it is a folder"), err)

  test("flights over links with special characters in their names have separate files, which reports read"):
    val folder = temporaryFolder()
    val words  = "fly --clock virtual --loop stream --duration 1s --link".split(' ').toSeq
    val flown  = Ran.of(Main.run(words ++ Seq("constant:50ms", "--out", folder.resolve("one").toString)))
    assertEquals(flown.status, 0, flown.err)
    assert(clue(flown.said).contains("Report: ") && !flown.said.contains("does not show"))
    val links = Seq("a b", "a_b").map(name => s"file:${Files.writeString(folder.resolve(name), "20\n")}")
    val both  = folder.resolve("both")
    val ran   = Ran.of(Main.run(words ++ Seq(links.head, "--link", links.last, "--out", both.toString)))
    assertEquals(ran.status, 1, ran.out)
    assert(clue(ran.err).contains("would both be recorded as") && ran.err.linesIterator.size == 1)
    assert(!Files.exists(both))

  recordings.test("a flight that is listed twice, or copied, counts once in a report, which states that"):
    folder =>
      val file   = folder.resolve("stream-vpn.duckdb")
      val copied = Files.copy(file, folder.resolve("copied.duckdb"))
      val words  =
        Seq(file, file, folder.resolve("./stream-vpn.duckdb"), copied, "--out", folder.resolve("report"))
      val (status, text, err) = run(ReportCommand(), words.map(_.toString)*)
      assertEquals((status, err), (0, ""))
      assert(clue(text).contains(s"$file is named twice, and counts once"))
      assert(text.contains(s"$copied is the same flight as $file, and counts once"))
      assertEquals(
        text.linesIterator.count(_.startsWith("stream ")),
        text.linesIterator.filter(_.startsWith("stream ")).distinct.size
      )

  recordings.test("report --json prints only the tables on standard output"): folder =>
    val files = Seq("paused-none", "stream-vpn").map(name => folder.resolve(s"$name.duckdb").toString)
    val (status, text, err) =
      run(ReportCommand(), files :+ "--json" :+ "--out" :+ folder.resolve("report").toString*)
    assertEquals(status, 0, err)
    val tables = ujson.read(text)("tables").arr
    val first  = tables.head
    val row    = first("rows").arr.find(row => row(0).str == "stream").getOrElse(fail(text))
    assertEquals(row.arr.size, first("columns").arr.size)
    assert(row(2).num > 10, row.toString)
    assert(err.contains("Report: "), err)

  private val flown = FunFixture[Path](
    _ =>
      val folder   = temporaryFolder()
      val settings = FlySettings(
        List(LoopKind.Stream),
        List(LatencyProfile.vpn),
        Span.ofSeconds(32),
        Span.ofMillis(100),
        seed = 5
      )
      assert(VirtualFlights.fly(settings, settings.plans, folder)((_, _) => ()).missing.isEmpty)
      folder
    ,
    path =>
      Using.resource(Files.walk(path))(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
  )

  test("identify fits a convoy's drones without its cars, and none of Skein's structures to cars"):
    val folder = temporaryFolder()
    val fly    = "fly --clock virtual --scenario convoy --loop stream --link none --duration 40s --out"
    assertEquals(Ran.of(Main.run(fly.split(' ').toSeq :+ folder.toString)).status, 0)
    val file  = folder.resolve("stream-none.duckdb").toString
    val drone = run(IdentifyCommand(), file)
    assertEquals(drone._1, 0, drone._3)
    assert(clue(drone._3).contains("left out: the cars Lead, Rear; --vehicle chooses them"))
    assert(clue(drone._2).contains("3 flights of one vehicle"))
    val car = run(IdentifyCommand(), file, "--vehicle", "Lead")
    assertEquals(car._1, 1)
    assert(clue(car._3).contains("expected multirotors for a structure of Skein, got the cars Lead"))

  test("identify fits velocities without an altitude to hold, at no altitude, and not with others"):
    val folder                = temporaryFolder()
    def fly(scenario: String) =
      val words = s"fly --clock virtual --scenario $scenario --loop stream --link none --duration 30s --out"
      assertEquals(Ran.of(Main.run(words.split(' ').toSeq :+ folder.resolve(scenario).toString)).status, 0)
      folder.resolve(scenario).resolve("stream-none.duckdb").toString
    val (shadow, slope)   = (fly("shadow"), fly("surround"))
    val (status, _, said) = run(IdentifyCommand(), shadow)
    assertEquals(status, 0, said)
    val model = ModelFile.read(folder.resolve("shadow/model.conf").toString).fold(fail(_), identity)
    assertEquals(model.altitudeM, None)
    // The quadrotor that the section compares with flies the recorded commands, so it lags as little.
    assert(clue(model.reduced.get.lagS) < 1)
    val mixed = run(IdentifyCommand(), shadow, slope)
    assertEquals(mixed._1, 1)
    assert(clue(mixed._3).contains("expected either velocities or velocities that hold an altitude"))

  flown.test("identify finds the quadrotor's model in a flight over the VPN, and writes a file for fly"):
    folder =>
      // A program's own structures are all fitted, too, and one that cannot be fitted is named.
      def own(label: String, parameters: Int)(plant: Vector[Double] => ReducedModel) =
        Structure(label, SearchSpace(Vector.tabulate(parameters)(i => Axis(s"lag-$i-s", 0.02, 30, 1))), plant)
      val plain               = own("plain", 1)(values => ReducedModel.lag(1, values(0), 0))
      val rich                = own("rich", 12)(values => ReducedModel.lag(1, values.sum, 0))
      given Scenarios         = PaperReport.scenarios.copy(ownStructures = Vector(plain, rich))
      val (status, text, err) = run(IdentifyCommand(), folder.resolve("stream-vpn.duckdb").toString)
      assertEquals(status, 0, err)
      assert(
        text.contains("position p50 m") && text.contains("drag-and-turn") && text.contains("plain"),
        text
      )
      assert(err.contains("rich is not fitted: expected at least 120 s of flight"), err)
      assert(Files.size(folder.resolve("model.svg")) > 10000)
      val file  = ModelFile.read(folder.resolve("model.conf").toString).fold(fail(_), identity)
      val named = ReducedModel.AirSim
      assertEquals(file.use, Structure.Drag)
      assertEquals(file.models.keySet, Structure.ours.toSet + plain)
      val model = file.plant match
        case model: ReducedModel => model
        case other               => fail(s"expected a reduced model, got $other")
      assertEqualsDouble(model.gain, named.gain, 0.1, file.toString)
      assertEqualsDouble(model.lagS, named.lagS, 0.1 * named.lagS, file.toString)
      assertEqualsDouble(model.deadTimeS, named.deadTimeS, 0.04, file.toString)
      assertEqualsDouble(
        file.reduced.get.lagS,
        ReducedModel.AirSimLag.lagS,
        0.1 * ReducedModel.AirSimLag.lagS,
        file.toString
      )
      val flags = ConfigFactory.parseString(s"skein.fly.predictor = \"${folder.resolve("model.conf")}\"")
      val read  = FlySettings.read(flags.withFallback(ConfigFactory.load()).resolve())
      assertEquals(read.map(_.predictor), Right(PredictionModel.Fitted(model, file.altitudeM)))
      assertEquals(file.altitudeM, Some(20.0))

  recordings.test("an unreadable model, and flights that cannot be fitted, are reported"): folder =>
    val broken =
      Files.writeString(folder.resolve("broken.conf"), "skein.model { use = drag, drag { gain.value = 1 } }")
    val (status, _, err) =
      run(SpreadCommand("skein.cli.Main"), "--seeds", "1", "--predictor", broken.toString)
    assertEquals(status, 1)
    assert(err.contains("lag-s"), err)
    val (unfit, _, reason) = run(IdentifyCommand(), folder.resolve("paused-none.duckdb").toString)
    assertEquals(unfit, 1)
    assert(reason.contains("expected"), reason)

  recordings.test("a vehicle's name that no recording has is refused, also beside one that a recording has"):
    folder =>
      val names            = Seq("--vehicle", "Pursuer", "--vehicle", "Evadr")
      val (status, _, err) = run(IdentifyCommand(), names :+ folder.resolve("stream-vpn.duckdb").toString*)
      assertEquals(status, 1)
      assert(clue(err).contains("--vehicle: expected one of ") && err.endsWith(", got Evadr\n"))

  folder.test("replay names every file that cannot be read"): folder =>
    val files = Seq("one.txt", "other.txt").map(name => Files.writeString(folder.resolve(name), "x").toString)
    val (status, _, err) = run(ReplayCommand(), files*)
    assertEquals(status, 1)
    for file <- files do assert(clue(err).contains(s"$file is not a recording"))

  folder.test("a fitted link does not change the round trips of an earlier one"): folder =>
    def fitted(firstMs: Int) =
      val trips = Vector.tabulate(40)(number => s"$number,${firstMs + number}").mkString("\n")
      val file  = Files.writeString(folder.resolve(s"from-$firstMs.csv"), s"time_s,rtt_ms\n$trips\n")
      run(LinkFitCommand, file.toString, "--out", folder.resolve("link").toString)
    val measured = folder.resolve("link/round-trips.txt")
    assertEquals(fitted(20)._1, 0)
    val before           = Files.readString(measured)
    val (status, _, err) = fitted(90)
    assertEquals(status, 1)
    assert(clue(err).contains(s"--out: $measured holds other round trips"))
    assertEquals(Files.readString(measured), before)
    assertEquals(fitted(20)._1, 0)

  recordings.test("a flight that is listed twice, or copied, is fitted only once"): folder =>
    val flight               = folder.resolve("stream-vpn.duckdb")
    val copy                 = Files.copy(flight, folder.resolve("copy.duckdb"))
    val (status, _, mistake) = run(IdentifyCommand(), flight.toString, copy.toString)
    assertEquals(status, 1)
    assert(mistake.contains(s"expected every flight once, got the same one in $flight and $copy"), mistake)

  recordings.test("report without --out writes to the folder of the first recording"): folder =>
    assertEquals(run(ReportCommand(), folder.resolve("stream-vpn.duckdb").toString)._1, 0)
    assert(Files.exists(folder.resolve("figures/distance.svg")))

  recordings.test("report lists a file that is not a recording, and writes nothing"): folder =>
    val text             = Files.writeString(folder.resolve("notes.txt"), "nothing")
    val (status, _, err) = run(ReportCommand(), folder.resolve("stream-vpn.duckdb").toString, text.toString)
    assertEquals(status, 1)
    assert(err.contains(s"$text is not a recording"), err)
    assert(!Files.exists(folder.resolve("report.html")))

  recordings.test(
    "equal contents in different files have equal digests, and different contents different ones"
  ): folder =>
    val again = folder.resolve("again.duckdb")
    write(SyntheticFlight("stream", "vpn", seed = 1, seconds = 12), again)
    val files = Seq(folder.resolve("stream-vpn.duckdb"), again, folder.resolve("paused-none.duckdb"))
    val (status, text, err) = run(DigestCommand, files.map(_.toString)*)
    assertEquals((status, err), (0, ""))
    val lines = text.linesIterator.map(_.split("  ", 2).toSeq).toSeq
    assertEquals(lines.map(_(1)), files.map(_.toString))
    assertEquals(lines(0)(0), lines(1)(0))
    assertNotEquals(lines(0)(0), lines(2)(0))

  recordings.test("export writes Parquet files of one recording"): folder =>
    val parquet = folder.resolve("parquet")
    assertEquals(
      run(ExportCommand, folder.resolve("stream-vpn.duckdb").toString, "--parquet", parquet.toString)._1,
      0
    )
    assert(Files.size(parquet.resolve("decision.parquet")) > 1000)

  recordings.test("a recording exported with --mcap and imported again is unchanged"): folder =>
    val recording     = folder.resolve("stream-vpn.duckdb").toString
    val mcap          = folder.resolve("flight.mcap").toString
    val again         = folder.resolve("again.duckdb").toString
    val (wrote, _, _) = run(ExportCommand, recording, "--mcap", mcap)
    assertEquals(wrote, 0)
    val (status, text, err) = run(ImportCommand, mcap, "--recording", again)
    assertEquals((status, err), (0, ""))
    val (_, digest, _) = run(DigestCommand, recording)
    assertEquals(text.takeWhile(_ != ' '), digest.takeWhile(_ != ' '))
    assertEquals(run(ImportCommand, mcap, "--recording", again)._1, 1)

  recordings.test("every path in the layout for Foxglove is in the exported files"): folder =>
    val mcap = folder.resolve("flight.mcap")
    assertEquals(
      run(ExportCommand, folder.resolve("stream-vpn.duckdb").toString, "--mcap", mcap.toString)._1,
      0
    )
    val schemas = McapFile.stream(mcap): records =>
      records
        .map(_.fold(error => fail(error.message), _.record))
        .collect { case channel: McapRecord.Channel =>
          channel.topic -> ujson.read(records.schema(channel.schemaId).get.data.utf8)
        }
        .toMap
    val layout = ujson.read(Files.readString(Documentation.root.resolve("docs/guides/foxglove-layout.json")))
    val panels = layout("configById").obj
    val plots  = panels.values.flatMap(_.obj.get("paths").toSeq.flatMap(_.arr)).map(_("value").str).toSeq
    val path   = """(/[\w/]+)(?:\{vehicle=="\w+"\})?\.(\w+)""".r
    assertEquals(plots.size, 12)
    plots.foreach:
      case path(topic, field) => assert(schemas(topic)("properties").obj.contains(field), s"$topic.$field")
      case other              => fail(other)
    // The duel's vehicles, and a forest's scouts with their lidars; two vehicles' front cameras.
    val scouts  = (1 to 5).map(number => s"Scout$number").toVector
    val sensors = scouts.map(ImagingSensor(_, "lidar", isLidar = true)) ++
      Seq("Pursuer", "Evader").map(ImagingSensor.camera(_, "front_center", "Scene"))
    val known =
      schemas.keySet ++ (FlightTopics.all(scouts) ++ sensors.flatMap(FlightTopics.of(_))).map(_.name)
    val images = panels.values.flatMap(_.obj.get("imageMode")).toVector
    val shown  = panels("3D!flight")("topics").obj.keys.toSet + panels("RosOut!log")("topicToRender").str ++
      images.flatMap(mode => Seq(mode("imageTopic").str, mode("calibrationTopic").str))
    assertEquals((images.size, shown.diff(known)), (2, Set.empty[String]))

  recordings.test("export without a format lists the formats"): folder =>
    val (status, _, err) = run(ExportCommand, folder.resolve("stream-vpn.duckdb").toString)
    assertEquals(status, 1)
    assert(
      err.contains(
        "expected what to write, got nothing: ./skein export FILE --parquet DIR, --mcap FILE, or --rosbag DIR"
      ),
      err
    )

  recordings.test("export takes exactly one recording"): folder =>
    val (status, _, err) = run(ExportCommand, "--parquet", folder.toString)
    assertEquals(status, 1)
    assert(err.contains("expected one recording, got 0"), err)
