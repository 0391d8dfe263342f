package skein.report

import skein.measure.Twin
import skein.record.{FlightRow, ParameterRow, Recording, Simulator}
import skein.scenario.Scenarios
import skein.units.*

class TwinSuite extends munit.FunSuite:
  private given Scenarios = PaperReport.scenarios

  private def virtual(loop: String, link: String, seed: Long): Recording =
    SyntheticFlight(loop, link, seed, seconds = 12)

  private def live(loop: String, link: String, seed: Long): Recording =
    val recording = virtual(loop, link, seed)
    val flight    = recording.heading.flight.copy(clock = "real")
    recording.copy(heading = recording.heading.copy(flight = flight))

  test("a live flight is paired only with the virtual ones of its loop and link"):
    val set = Report.of(
      Seq(
        live("stream", "direct", 1),
        virtual("stream", "direct", 2),
        virtual("stream", "direct", 3),
        virtual("stream", "vpn", 4),
        live("sequential", "direct", 5)
      )
    )
    val twin = set.twins match
      case Vector(twin) => twin
      case others       => fail(s"expected one pair, got ${others.size}")
    assertEquals(twin.virtual.map(_.flight.seed), Vector(2L, 3L))
    assertEquals(twin.seeds, "2 seeds, 2 … 3")
    // Twins are shown only with their live flight; a virtual flight without one is an ordinary flight.
    assertEquals(
      set.flights.map(one => (one.flight.loop, one.flight.link)),
      Vector(("sequential", "direct"), ("stream", "direct"), ("stream", "vpn"))
    )

  test("a flight and its exact copy in virtual time differ by 0 in every quantity"):
    val twin = Report.of(Seq(live("stream", "direct", 1), virtual("stream", "direct", 1))).twins.head
    assertEquals(twin.compared.size, 4)
    assertEquals(twin.compared.map(_.distance), Vector.fill(4)(0.0))
    assertEquals(twin.difference, Some(0.0))
    assertEquals(twin.unlike, "")

  test(
    "older data over another link show as that difference; distances are relative to the twin's distance"
  ):
    val other = live("stream", "vpn", 1)
    val vpn   = other.copy(heading =
      other.heading.copy(flight = other.flight.copy(link = "direct", simulator = Simulator.Other("robots")))
    )
    val twin   = Report.of(Seq(vpn, virtual("stream", "direct", 1))).twins.head
    val age    = twin.find("pursuer", Twin.Age).getOrElse(fail("no ages")).distance
    val (l, v) = twin.converged.getOrElse(fail("no distances"))
    assert(age > 0.9, s"$age")
    assertEqualsDouble(twin.difference.get, l / v - 1, 1e-12)
    assertEquals(twin.unlike, "simulator robots live, synthetic virtual")

  test(
    "a virtual flight with another duration, period, scenario or option is no twin, and stays in the tables"
  ):
    def changed(flight: FlightRow => FlightRow, parameters: ParameterRow*) =
      val one = virtual("predictive", "direct", 2)
      one.copy(heading =
        one.heading.copy(
          flight = flight(one.heading.flight),
          parameters = one.heading.parameters ++ parameters
        )
      )
    val others = Seq(
      changed(_.copy(duration = Span.ofSeconds(13))),
      changed(_.copy(period = Span.ofMillis(50))),
      changed(_.copy(scenario = "formation")),
      changed(identity, ParameterRow("predictor", "constant-velocity")),
      changed(identity, ParameterRow("movesInFlight", "6"))
    )
    val flown = live("predictive", "direct", 1)
    for other <- others do
      val set = Report.of(Seq(flown, other))
      assertEquals((set.twins, set.flights.size), (Vector.empty, 2))
    val names = Report.of(flown +: others).flights.map(_.name).distinct
    assert(clue(names).contains("predictive, constant-velocity, every 100 ms, for 12 s"))
    assertEquals(names.size, 6)

  test("the section is in the text and on the page only if there is a pair"):
    val paired = Report.of(Seq(live("stream", "direct", 1), virtual("stream", "direct", 2)))
    val page   = HtmlReport.render(paired, ReportSections.of(paired, ReportFigures.of(paired)))
    assert(page.contains("Live against virtual") && page.contains("KS 0."), "no section")
    val text = ReportSections.text(paired)
    assert(text.contains("Live against virtual") && text.contains("seed 2"), text)
    val alone = Report.of(Seq(live("stream", "direct", 1)))
    assert(!HtmlReport.render(
      alone,
      ReportSections.of(alone, ReportFigures.of(alone))
    ).contains("Live against virtual"))
    assert(!ReportSections.text(alone).contains("Live against virtual"))
