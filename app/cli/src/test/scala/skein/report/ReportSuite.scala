package skein.report

import java.nio.file.{Files, Path}
import javax.imageio.ImageIO
import javax.xml.parsers.DocumentBuilderFactory
import skein.figures.{Figure, TrajectoryFigure}
import skein.measure.{FlightSet, FlightSummary}
import skein.plot.{Drawing, Mark}
import skein.record.{Event, EventKind, MemoryRecorder, RecordError, Recording, Simulator}
import skein.scenario.{PaperDuel, ScenarioKind, Scenarios}
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.Decimals.fixed

class ReportSuite extends munit.FunSuite, TemporaryFolders, Unhurried:
  private given Scenarios = PaperReport.scenarios

  private lazy val set = Report.of(
    Seq(
      ("paused", "none"),
      ("sequential", "direct"),
      ("stream", "direct"),
      ("stream", "vpn")
    ).zipWithIndex.map:
      case ((loop, link), index) => SyntheticFlight(loop, link, seed = index)
  )

  folder.test("a report is one page and its figures, each as SVG and PNG"): folder =>
    val output = Report.write(set, folder.resolve("new/folder")).fold(fail(_), identity)
    assert(Files.size(output.page) > 10_000)
    val names = Set(
      "trajectories",
      "distance",
      "observations",
      "latency",
      "deviation",
      "graph-sequential",
      "graph-stream"
    )
    assertEquals(ReportFigures.of(set).all.map(_.name).toSet, names)
    for name <- names do
      val stem     = output.page.resolveSibling("figures").resolve(name).toString
      val document =
        DocumentBuilderFactory.newInstance().newDocumentBuilder().parse(Path.of(s"$stem.svg").toFile)
      assertEquals(document.getDocumentElement.getTagName, "svg")
      if output.withoutPng.isEmpty then
        val image = ImageIO.read(Path.of(s"$stem.png").toFile)
        val ratio = document.getDocumentElement.getAttribute("width").toDouble / image.getWidth
        assertEqualsDouble(ratio, 1 / 3.0, 0.001)

  test("all panels of trajectories have one range"):
    val texts = TrajectoryFigure(set).get.shapes.collect { case text: Mark.Text => text.content }
    val ticks = texts.filter(_.toDoubleOption.isDefined).groupMapReduce(identity)(_ => 1)(_ + _)
    assert(ticks.nonEmpty && ticks.values.forall(_ % set.flights.size == 0), ticks)

  folder.test("the printed next command can be typed, whatever the folder's name"): folder =>
    val (one, two) = (folder.resolve("it's a.duckdb"), folder.resolve("b.duckdb"))
    for (file, seed) <- Seq(one -> 1, two -> 2) do
      val flight = SyntheticFlight("stream", "direct", seed, seconds = 12)
      assert(MemoryRecorder(flight.heading).writeTo(file).isRight)
    val out = folder.resolve("it's so")
    Files.createDirectories(out): Unit
    Files.copy(two, out.resolve("c.duckdb")): Unit
    val set  = Report.read(Seq(one)).fold(errors => fail(errors.mkString), identity)
    val told = Report.write(set, out).fold(fail(_), identity).told.last
    assert(clue(told).endsWith(s"c, which are there too: ./skein report '$folder/it'\\''s so'/*.duckdb"))
    val beside = Report.write(set, folder, Seq(one)).fold(fail(_), identity)
    assertEquals(beside.others, Vector("b"))
    assertEquals(Typed.recordings(Path.of("")), "*.duckdb")
    assertEquals(Typed.recordings(Path.of("a/b")), "a/b/*.duckdb")
    assertEquals(Typed.recordings(Path.of("-a/b")), "./-a/b/*.duckdb")

  test("figures of one name have files of their own"):
    val names = Seq("a-measure", "a-measure-2", "b", "a-measure", "a-measure-2")
    val all   = names.map(Figure(_, "", "", Drawing(1, 1, Vector.empty))).toVector
    assertEquals(
      ReportFigures.numbered(all).map(_.name),
      Vector("a-measure", "a-measure-2", "b", "a-measure-3", "a-measure-2-2")
    )

  test("what recordings say cannot control a terminal"):
    val flown = SyntheticFlight("stream", "direct", seed = 1, seconds = 12)
    val event = Event(flown.flight.startedAt, EventKind.Starved, None, "late\u001b[2J")
    val text  = ReportSections.text(Report.of(Seq(flown.copy(events = Vector(event)))))
    assert(clue(text).contains("late\ufffd[2J") && !text.contains("\u001b"))

  folder.test("a file that is listed twice is one flight"): folder =>
    val flight = SyntheticFlight("stream", "direct", seed = 1, seconds = 12)
    val file   = folder.resolve("flight.duckdb")
    assert(MemoryRecorder(flight.heading).writeTo(file).isRight)
    val named = Seq(file, folder.resolve("./flight.duckdb"), file)
    assertEquals(Report.read(named).map(_.all.size), Right(1))

  test("the page is self-contained"):
    val page    = HtmlReport.render(set, ReportSections.of(set, ReportFigures.of(set)))
    val links   = "(?:src|href|url|@import)\\s*[=(]".r.findFirstIn(page)
    val scripts = "<script|<link|<iframe|<img".r.findFirstIn(page)
    val hosts   = "https?://[^\"]*".r.findAllIn(page).toSet
    assertEquals((links, scripts, hosts - "http://www.w3.org/2000/svg"), (None, None, Set.empty[String]))

  test("equal recordings give equal pages"):
    def page = HtmlReport.render(set, ReportSections.of(set, ReportFigures.of(set)))
    assertEquals(page, page)

  folder.test(
    "an exception of a scenario's own report is reported, and everything else is written"
  ): folder =>
    object Broken extends ScenarioKind(PaperDuel()), ScenarioReport:
      override def results(set: FlightSet): Vector[Section]                = sys.error("no results")
      override def figures(set: FlightSet): Vector[Figure]                 = sys.error("no figures")
      override def spread(flights: Vector[FlightSummary]): Vector[Section] = sys.error("no spread")
    given Scenarios        = Scenarios(Vector(Broken))
    def told(what: String) = s"the report of the scenario duel failed: java.lang.RuntimeException: no $what"
    val output             = Report.write(set, folder).fold(fail(_), identity)
    assertEquals(output.failures.map(_.takeWhile(_ != '(').trim), Vector(told("results"), told("figures")))
    assertEquals(output.whole, Left(output.failures.mkString("\n")))
    val page = Files.readString(output.page)
    for expected <- Vector("What happened", "Deviation") ++ Seq("results", "figures").map(told) do
      assert(page.contains(expected), expected)
    assert(ReportSections.text(set).contains("What happened"))
    val spread = Report.writeSpread(set.flights, folder).fold(fail(_), identity)
    assertEquals(spread.failures.map(_.takeWhile(_ != '(').trim), Vector(told("spread")))
    assert(Files.readString(spread.page).contains("Deviation"))

  test("text from a recording cannot become markup"):
    val flight = SyntheticFlight("stream", "direct", seed = 1, seconds = 12)
    val named  = flight.heading.flight.copy(simulator = Simulator.Other("<b onload=\"x\">&"), link = "<i>")
    val page   =
      HtmlReport.render(Report.of(Seq(flight.copy(heading = flight.heading.copy(flight = named)))), Nil)
    assert(!page.contains("<b onload"), "the simulator's name was not escaped")
    assert(!page.contains("<i>"), "the link's name was not escaped")

  test("a flight without any record still gives a page and a table"):
    val empty = SyntheticFlight("stream", "direct", seed = 1, seconds = 12).heading
    val set   = Report.of(Seq(Recording(empty)))
    assert(HtmlReport.render(set, ReportSections.of(set, ReportFigures.of(set))).contains("Skein"))
    assert(ReportSections.text(set).contains("stream"))

  test("the tables have our values next to the paper's"):
    val stream = SummaryTables.distances(set).rows.find(row => row(0) == "stream" && row(1) == "vpn").get
    val ours   = set.flights.find(_.flight.id == "stream-vpn").flatMap(_.distance).get.lastTenSeconds.get.mean
    assert(stream.contains(ours.fixed(2)), stream)
    assert(stream.contains("8.50"), stream)

  test("columns of a text table are aligned with their names"):
    val table =
      TextTable(Vector("<name", "m"), Vector(Vector("a", "10.5"), Vector("lon\u001b name", "2")))
    assertEquals(
      table.render,
      """name          m
        |─────────  ────
        |a          10.5
        |lon� name     2""".stripMargin
    )

  folder.test("every unreadable file is listed"): folder =>
    val good = folder.resolve("good.duckdb")
    assert(MemoryRecorder(SyntheticFlight("stream", "direct", 1, 12).heading).writeTo(good).isRight)
    val missing = folder.resolve("missing.duckdb")
    val text    = Files.writeString(folder.resolve("text.duckdb"), "nothing")
    assertEquals(
      Report.read(Seq(good, missing, text)),
      Left(Seq(RecordError.NoSuchFile(missing), RecordError.NotARecording(text, "it is not a DuckDB file")))
    )
    assert(Report.read(Seq(good)).isRight)
