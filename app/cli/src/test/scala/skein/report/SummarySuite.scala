package skein.report

import skein.cli.OurScenarios
import skein.figures.DetectionFigure
import skein.measure.{
  DistanceCurve,
  Distribution,
  FlightSummary,
  Published,
  RecordedSeeing,
  TimingObservation
}
import skein.record.*
import skein.scenario.Scenarios
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.units.Decimals.brief

class SummarySuite extends munit.FunSuite:
  private given Scenarios = DuelReport.scenarios

  private def second(time: Double): Instant = Instant.Epoch + Span.ofSeconds(time)

  private def seen(vehicle: String, time: Double, x: Double, y: Double): ReadingRow =
    val state = Kinematics(Vector3(x, y, -20), Vector3.Zero, Quaternion.Identity, Vector3.Zero)
    ReadingRow(0, vehicle, Stamped(state, second(time), second(time), second(time + 0.04)))

  private val heading = RecordingHeader(
    FlightRow(
      "f",
      "stream",
      "direct",
      1,
      Span.ofMillis(100),
      Span.ofSeconds(60),
      "virtual",
      Simulator.Other(""),
      "",
      "",
      second(0)
    ),
    Seq(
      VehicleRow("Red", "Pursuer", MetresPerSecond(10), Vector3.Zero),
      VehicleRow("Blue", "Evader", MetresPerSecond(5), Vector3.Zero)
    )
  )

  private def curveOf(records: Record*): DistanceCurve =
    FlightSummary.of(Recording(heading, records)).distance.getOrElse(fail("expected a distance"))

  test("quantiles are interpolated linearly between samples"):
    val distribution = Distribution.of(Seq(40.0, 10, 30, 20)).get
    assertEqualsDouble(distribution.median, 25, 1e-12)
    assertEqualsDouble(distribution.quantile(0), 10, 0)
    assertEqualsDouble(distribution.quantile(1), 40, 0)
    assertEqualsDouble(distribution.quantile(0.1), 13, 1e-12)
    assertEqualsDouble(distribution.mean, 25, 1e-12)
    assertEqualsDouble(distribution.sd, math.sqrt(125), 1e-12)

  test("distances are taken at equal simulator times, interpolated between samples"):
    // The pursuer flies north at 2 m/s, the evader at 1 m/s from 10 m on, 3 m to the east; sampled in turns.
    val curve = curveOf(
      (for tick <- 0 to 20 yield seen("Red", tick * 0.5, tick * 1.0, 0)) ++
        (for tick <- 0 to 20 yield seen("Blue", 0.25 + tick * 0.5, 10.25 + tick * 0.5, 3))*
    )
    assertEqualsDouble(curve.points.last._1, 9.74, 1e-9)
    for (time, distance) <- curve.points do
      assertEqualsDouble(distance, math.hypot(10 - (time + 0.25), 3), 1e-9)

  test("the smallest distance is found with its time"):
    val curve = curveOf(
      (for tick <- 0 to 40 yield seen("Red", tick * 0.5, tick * 0.5, 0)) ++
        (for tick <- 0 to 40 yield seen("Blue", tick * 0.5, 12, 4))*
    )
    assertEqualsDouble(curve.closest._1, 12, 1e-9)
    assertEqualsDouble(curve.closest._2, 4, 1e-9)

  test("the last 10 s are the curve's own, weighted evenly in time"):
    // 5 m apart for 10 s, then 8 m, then 9 m over the last 2.5 s.
    val apart = Seq(0.0 -> 5.0, 9.99 -> 5.0, 10.0 -> 8.0, 17.49 -> 8.0, 17.5 -> 9.0, 20.0 -> 9.0)
    val curve = curveOf(
      apart.map((time, distance) => seen("Red", time, distance, 0)) ++ apart.map((time, _) =>
        seen("Blue", time, 0, 0)
      )*
    )
    assertEqualsDouble(curve.lastTenSeconds.get.mean, 8.25, 0.01)
    assertEqualsDouble(curve.lastTenSeconds.get.least, 8, 1e-9)
    assertEqualsDouble(curve.lastTenSeconds.get.most, 9, 1e-9)

  test("recorded true positions are preferred to readings"):
    val readings =
      Seq(seen("Red", 0, 0, 0), seen("Red", 1, 0, 0), seen("Blue", 0, 5, 0), seen("Blue", 1, 5, 0))
    val truths =
      for
        time         <- Seq(0.0, 1.0)
        (vehicle, x) <- Seq("Red" -> 0.0, "Blue" -> 7.0)
      yield Truth(vehicle, second(time), Vector3(x, 0, -20))
    assertEqualsDouble(curveOf(readings ++ truths*).closest._2, 7, 1e-12)

  test("a flight in which one vehicle was never read has no distance"):
    assertEquals(FlightSummary.of(Recording(heading, Seq(seen("Red", 0, 0, 0)))).distance, None)

  test("observations are grouped by the deciding vehicle's role"):
    val recording = SyntheticFlight("stream", "direct", seed = 1, seconds = 12)
    val summary   = FlightSummary.of(recording)
    assertEquals(summary.roles.map(_.role), Vector("evader", "pursuer"))
    assertEquals(summary.decisions, recording.decisions.size)
    val ofEvader = recording.decisions.filter(_.vehicle == "Evader")
    val own      = ofEvader.map(_.observations.ownAge.toMillis)
    assertEqualsDouble(summary.roles.head.observedMs(TimingObservation.OwnAge).mean, own.sum / own.size, 1e-9)
    // The first decision has no move before it.
    assertEquals(summary.roles.head.observedMs(TimingObservation.SinceOwnMove).count, ofEvader.size - 1)

  test("the table of observations has mean, median and the 99 % quantile"):
    val recording = SyntheticFlight("stream", "direct", seed = 1, seconds = 12)
    val table     = SummaryTables.observations(Report.of(Seq(recording)))
    val ages      = recording.decisions
      .filter(_.vehicle == "Evader")
      .map(_.observations.ownAge.toMillis)
      .sorted
    def quantile(p: Double) =
      val place = p * (ages.size - 1)
      val below = place.toInt
      ages(below) + (place - below) * (ages((below + 1).min(ages.size - 1)) - ages(below))
    val expected =
      Vector(ages.sum / ages.size, quantile(0.5), quantile(0.99)).map(_.brief).mkString("/")
    assertEquals(table.rows.head.take(4), Vector("stream", "direct", "evader", expected))
    assertNotEquals(quantile(0.99).brief, quantile(0.95).brief)

  test("a flight's deviation is relative to the paused flight of its set"):
    val stream = SyntheticFlight("stream", "vpn", seed = 2, seconds = 20)
    val paused = SyntheticFlight("paused", "none", seed = 3, seconds = 20)
    val set    = Report.of(Seq(stream, paused))
    val means  = set.flights.map(_.distance.get.lastTenSeconds.get.mean)
    assertEquals(set.flights.map(_.flight.loop), Vector("paused", "stream"))
    assertEquals(set.deviation(set.flights(0)), None)
    assertEqualsDouble(set.deviation(set.flights(1)).get, means(1) / means(0) - 1, 1e-12)
    assertEquals(Report.of(Seq(stream)).deviation(set.flights(1)), None)

  test("a flight is compared only with paused ones of equal period, duration and settings"):
    def flight(recording: Recording)(change: FlightRow => FlightRow) =
      recording.copy(heading = recording.heading.copy(flight = change(recording.heading.flight)))
    val stream                    = SyntheticFlight("stream", "vpn", seed = 2, seconds = 20)
    val paused                    = SyntheticFlight("paused", "none", seed = 3, seconds = 20)
    def against(truth: Recording) =
      val set = Report.of(Seq(stream, truth))
      set.deviation(set.flights.find(_.flight.loop == "stream").get)
    assert(against(paused).isDefined)
    assertEquals(against(SyntheticFlight("paused", "none", seed = 3, seconds = 15)), None)
    assertEquals(against(flight(paused)(_.copy(period = Span.ofMillis(400)))), None)

  test("a published flight is next to ours of its loop and link, and the paused one next to any"):
    assertEquals(Published.flight(LoopKind.Stream, "vpn").flatMap(_.distance).map(_.mean), Some(8.5))
    assertEquals(Published.flight(LoopKind.Paused, "none").flatMap(_.distance).map(_.mean), Some(8.53))
    assertEquals(Published.flight(LoopKind.Stream, "none"), None)

  test(
    "a flight shorter than 10 s has no last 10 s; the paper's figures are next to flights of a minute"
  ):
    def rows(seconds: Int) =
      SummaryTables.distances(Report.of(Seq(SyntheticFlight("stream", "direct", 1, seconds))))
    val (header, short) = (rows(6).header, rows(6).rows.head)
    val (longer, long)  = (rows(12).rows.head, rows(60).rows.head)
    val (last, paper)   = (header.indexOf("last 10 s m"), header.indexOf("paper m"))
    assertEquals((short(last), short(paper)), ("< 10 s", ""))
    assertEquals((longer(paper), long(paper)), ("", "9.31"))
    assert(longer(last).toDouble > 0)

  test("a flight that ended early is marked in tables and page, is not compared, and states why"):
    val whole                                          = SyntheticFlight("stream", "direct", 1, 20)
    val paused                                         = SyntheticFlight("paused", "none", 2, 20)
    def of(ending: Option[Ending])                     = Report.of(Seq(whole.copy(ending = ending), paused))
    def ended(how: EndingKind, reason: Option[String]) = Some(Ending(second(0), how, reason))
    assertEquals(of(ended(EndingKind.Completed, None)).flights.flatMap(_.cutShort), Vector.empty)
    val cut  = of(ended(EndingKind.Failed, Some("the disk is full")))
    val text = ReportSections.text(cut)
    assert(text.contains("stream, cut short"), text)
    assert(text.contains("stream-direct was cut short, after 1"), text)
    assert(text.contains("of 20 s: the disk is full"), text)
    assert(HtmlReport.render(cut, Seq.empty).contains("of 20 s: the disk is full"))
    val row    = SummaryTables.distances(cut).rows.find(_.head.startsWith("stream")).get
    val header = SummaryTables.distances(cut).header
    assertEquals(row(header.indexOf("paper m")), "")
    assertEquals(cut.deviations, Vector.empty)

  test("a camera without a detection is in the table"):
    val duel  = SyntheticFlight("stream", "direct", 1, 12)
    val named = duel.heading.flight.copy(scenario = "blind-pursuit")
    val blind = duel.copy(heading = duel.heading.copy(flight = named))
    val set   = Report.of(Seq(blind))(using OurScenarios.all)
    assertEquals(
      SummaryTables.seen(set.flights).rows.map(_.take(7)),
      Vector(Vector("stream", "direct", "Pursuer", "Evader", "", "0", ""))
    )
    assertEquals(DetectionFigure(set), None)
    assertEquals(RecordedSeeing.of(blind)(using OurScenarios.all), Vector.empty)

  test("a truncated recording is recognised, even without an end record"):
    val broken  = SyntheticFlight("stream", "direct", 1, 12)
    val planned = broken.heading.flight.copy(duration = Span.ofSeconds(25))
    val summary = FlightSummary.of(broken.copy(heading = broken.heading.copy(flight = planned)))
    assert(
      summary.cutShort.exists(_.startsWith("the recording breaks off after 1")),
      summary.cutShort.toString
    )
