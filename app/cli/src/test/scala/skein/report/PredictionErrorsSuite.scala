package skein.report

import skein.flight.VirtualFlights
import skein.figures.{FlightTheme, PredictionFigure}
import skein.loop.LoopKind
import skein.measure.{Deviation, FlightSet, FlightSummary, PredictionErrors, PredictionGroup}
import skein.plot.Mark
import skein.scenario.Scenarios
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.testing.Unhurried
import skein.units.*

class PredictionErrorsSuite extends munit.FunSuite, Unhurried:
  private given Scenarios = PaperReport.scenarios

  test("errors are grouped by age around multiples of 20 ms, and small groups are left out"):
    val samples = Vector.tabulate(40)(index => (91.0 + index % 18, index / 1000.0)) ++
      Vector.fill(PredictionErrors.Fewest - 1)((50.0, 9.0))
    val errors = PredictionErrors(made = 90, samples)
    assertEquals(errors.unverified, 90 - 79)
    assertEquals(errors.byAge.map(_._1), Vector(100))
    assertEquals(errors.around(100).map(_.count), Some(40))
    assertEqualsDouble(errors.around(100).get.quantile(0.95), 0.95 * 0.039, 1e-9)
    assertEquals(errors.around(200), None)
    assertEquals(errors.samples.count(_._1 == 50.0), PredictionErrors.Fewest - 1)
    assertEquals(errors.around(60), None)

  test("the table has no 95 % quantile of a small group"):
    def p95(count: Int) =
      val errors = PredictionErrors(count, Vector.fill(count)((100.0, 0.012)))
      PredictionTable.of(Vector(PredictionGroup("stream", "vpn", errors, PredictionErrors(0, Vector.empty))))
        .rows.head.last
    assertEquals((p95(PredictionErrors.Fewest - 1), p95(PredictionErrors.Fewest)), ("", "12.0"))

  private def measured(agesMs: Int*) =
    val samples = agesMs.toVector.flatMap(age => Vector.fill(PredictionErrors.Fewest)((age.toDouble, 0.01)))
    PredictionErrors(samples.size, samples)

  test("points are not joined across ages without measurements"):
    assertEquals(
      measured(40, 60, 140, 160, 180, 240).stretches.map(_.map(_._1)),
      Vector(Vector(40, 60), Vector(140, 160, 180), Vector(240))
    )
    assertEquals(measured().stretches, Vector.empty)

  test("curves have gaps at ages without measurements, and the legend lists only drawn items"):
    def texts(of: PredictionGroup) =
      PredictionFigure(Vector(of)).get.shapes.collect { case text: Mark.Text => text.content }
    def curves(of: PredictionGroup) = PredictionFigure(Vector(of)).get.shapes.count:
      case Mark.Path(points, Some(_), None, false) => points.size >= 3
      case _                                       => false
    val own  = PredictionGroup("predictive", "vpn", measured(20, 40, 60, 120, 140, 160), measured())
    val both = own.copy(others = measured(20, 40, 60))
    // The median and the 95 % quantile of each stretch.
    assertEquals((curves(own), curves(both)), (4, 6))
    assert(
      texts(own).exists(_.contains("own vehicle")) && !texts(own).exists(_.contains("others")),
      texts(own)
    )
    assert(texts(both).contains("others, median"), texts(both))

  test("two ages do not make a curve, in the picture and in its legend"):
    val shapes =
      PredictionFigure(Vector(PredictionGroup("predictive", "vpn", measured(20, 40), measured()))).get.shapes
    // Two discs each for the median and the 95 % quantile, and one each in the legend.
    assertEquals(shapes.count { case _: Mark.Disc => true; case _ => false }, 6)
    val sloped = shapes.collect:
      case Mark.Path(points, Some(stroke), _, false)
          if stroke.colour.rgb == FlightTheme.of("predictive").rgb => points
    assertEquals(sloped, Vector.empty)

  private lazy val flights =
    fly(List(LoopKind.Paused, LoopKind.Stream, LoopKind.Predictive), Span.ofMillis(100))

  private def fly(loops: List[LoopKind], period: Span) =
    val settings = FlySettings(
      loops,
      List(LatencyProfile.direct),
      duration = Span.ofSeconds(12),
      period = period,
      seed = 1
    )
    VirtualFlights
      .inParallel(settings, settings.plans)(flown => FlightSummary.of(flown.recorder.recording))
      .map(_.fold(missing => fail(missing.message), identity))

  test("every prediction of a flight is counted: verified with its error, or unverified"):
    val group = PredictionGroup.of(flights) match
      case Vector(group) => group
      case others        => fail(s"expected predictions of one loop, got ${others.size}")
    assertEquals((group.name, group.link), ("predictive", "direct"))
    for errors <- Seq(group.own, group.others) do
      assert(
        errors.made >= 200 && errors.unverified >= 0 && errors.unverified < 20,
        s"${errors.made} ${errors.unverified}"
      )
      assert(errors.errors.get.quantile(0.95) < 0.1, errors.errors.get.quantile(0.95).toString)
    assert(ReportFigures.spread(flights).all.map(_.name).contains("prediction"))

  test("predictions are counted even if none was verified"):
    val groups = PredictionGroup.of(fly(List(LoopKind.Predictive), Span.ofMillis(400)))
    for errors <- groups.flatMap(group => Seq(group.own, group.others)) do
      assert(errors.made >= 50 && errors.unverified == errors.made, s"${errors.made} ${errors.unverified}")
    assertEquals(PredictionTable.of(groups).rows.size, 2)

  test("deviations are relative to the paused flight, by loop, link and clock"):
    val deviations = Deviation.of(flights)
    assertEquals(
      deviations.map(one => (one.loop, one.link)),
      Vector(("stream", "direct"), ("predictive", "direct"))
    )
    val metres = flights.map(one => one.flight.loop -> one.headline.get).toMap
    assertEqualsDouble(deviations.head.share.mean, metres("stream") / metres("paused") - 1, 1e-12)
    assertEquals(Deviation.of(flights.filterNot(_.flight.loop == "paused")), Vector.empty)

  test("flights of different scenarios are neither averaged nor judged together"):
    val others = flights.map(one => one.copy(flight = one.flight.copy(scenario = "other"), scenario = None))
    val groups = PredictionGroup.of(flights ++ others)
    assertEquals(groups.map(_.scenario), Vector("duel", "other"))
    assertEquals(Deviation.of(flights ++ others).map(_.scenario).distinct, Vector("duel"))
    val said = TimingVerdict.sentence(FlightSet(flights ++ others)).get
    assert(clue(said).contains("stream in duel") && said.contains("stream in other"))

  test("the sections are in the text, on the report's page and on a spread's page"):
    val set  = FlightSet(flights)
    val text = ReportSections.text(set)
    assert(text.contains("Deviation from the paused truth") && text.contains("p95 at 100 ms, mm"), text)
    val pages =
      Seq(
        HtmlReport.render(set, ReportSections.of(set, ReportFigures.of(set))),
        HtmlReport.spread(flights.size, ReportSections.spread(flights, ReportFigures.spread(flights)))
      )
    for page <- pages do
      assert(
        page.contains("Deviation from the paused truth") && page.contains("Prediction error")
      )
