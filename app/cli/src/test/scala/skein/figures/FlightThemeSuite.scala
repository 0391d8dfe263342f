package skein.figures

import skein.loop.LoopKind
import skein.measure.{FlightSet, FlightSummary}
import skein.plot.{Mark, Point}
import skein.report.PaperReport
import skein.report.SyntheticFlight
import skein.scenario.Scenarios

class FlightThemeSuite extends munit.FunSuite:
  private given Scenarios = PaperReport.scenarios

  test("each loop has its own colour, and unknown loops have another"):
    val colours =
      LoopKind.values.toVector.map(loop => FlightTheme.of(loop.label)) :+ FlightTheme.of("a loop to come")
    assertEquals(colours.distinct.size, LoopKind.values.length + 1)

  test("curves can be distinguished without colours: each has its own dashes, also in the legend"):
    val flights = LoopKind.values.toVector.map: loop =>
      FlightSummary.of(SyntheticFlight(loop.label, "vpn", seed = 1, seconds = 12))
    val all    = flights ++ flights.map(_.copy(policy = Some("pure-pursuit")))
    val curves = FlightTheme.curves(all)
    assertEquals(all.map(flight => curves(flight.name).dash).distinct.size, 12)
    val shown = FlightTheme.names(all, curves).flatMap(_.mark(Point(0, 0))).collect:
      case Mark.Path(_, Some(stroke), _, _) => stroke.dash
    assertEquals(shown, all.map(flight => curves(flight.name).dash))

  test("flights are in the order of the loops, whatever their order before"):
    val flights = LoopKind.values.reverse.toVector.filter(_ != LoopKind.Paused).map: loop =>
      FlightSummary.of(SyntheticFlight(loop.label, "vpn", seed = 1, seconds = 12))
    assertEquals(FlightSet(flights).flights.map(_.flight.loop), flights.reverse.map(_.flight.loop))
