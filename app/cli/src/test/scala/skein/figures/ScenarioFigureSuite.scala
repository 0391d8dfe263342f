package skein.figures

import skein.measure.{FlightSummary, ScenarioFlights, ScenarioNames}
import skein.plot.{Drawing, Mark}
import skein.policy.Agent
import skein.report.SyntheticFlight
import skein.scenario.{Crossing, Limit, Result, Scenario, Series, Track, Tracks}
import skein.units.*

/** Figures of two vehicles with coinciding trajectories, one above the other, below a ceiling. */
class ScenarioFigureSuite extends munit.FunSuite:
  import ScenarioFigureSuite.*

  private lazy val summary =
    FlightSummary.of(SyntheticFlight("stream", "vpn", seed = 1, 12))(using skein.scenario.Scenarios.ours)

  private def flown(ceilingM: Double): ScenarioFlights = flown(Capped(ceilingM))

  private def flown(scenario: Scenario): ScenarioFlights =
    def track(name: String, upM: Double) = Track.of(
      name,
      "crosser",
      (0 to 100).toVector.map(step =>
        (Instant.ofNanos(step * 100_000_000L), Vector3(step * 0.5, 0, -upM), Vector3(5, 0, 0))
      )
    )
    val tracks = Tracks.of(Vector(track("One", 5), track("Two", 7))).get
    ScenarioFlights(
      scenario,
      Vector(ScenarioFlights.Flown(summary, Result.of(scenario, tracks))),
      withoutResult = Vector.empty,
      scenario.name
    )

  test("scenarios of one name are told apart by the settings in which they differ"):
    val (low, high) = (Capped(50), Capped(100))
    val names       = ScenarioNames.of(Seq(low, high, low))
    assertEquals(Seq(low, high).map(names(_)), Seq("capped, ceilingM 50.0", "capped, ceilingM 100.0"))
    assertEquals(ScenarioNames.of(Seq(low))(low), "capped")

  private def texts(drawing: Drawing) = drawing.shapes.collect { case text: Mark.Text => text.content }

  /** Strokes of curves with at least this many points. */
  private def strokes(drawing: Drawing) =
    drawing.shapes.collect { case Mark.Path(points, Some(stroke), None, false) if points.size > 20 => stroke }

  test("coinciding vehicles are distinguished by name in the legend, and by a wider first line"):
    val figure = ScenarioFigure.trajectories(flown(100))
    val names  = Capped(100).agents.map(_.name)
    assert(names.forall(texts(figure).contains), texts(figure))
    val lines = strokes(figure).filter(_.dash.isEmpty)
    assertEquals(lines.map(_.colour.rgb).distinct.size, 2)
    assert(lines(0).width > lines(1).width + 1, lines)

  test("a broken ceiling is drawn and in the legend, and a distant one is not"):
    def isRed(mark: Mark) = mark match
      case Mark.Disc(_, 5, Some(stroke), None) => stroke.colour.rgb == 0xcc0000
      case _                                   => false
    val broken = ScenarioFigure.altitudes(flown(6))
    assert(texts(broken).contains("altitude of at most 6 m") && texts(broken).contains("a limit broken"))
    // One in the panel and one in the legend.
    assertEquals(broken.shapes.count(isRed), 2)
    assertEquals(ScenarioFigure.hasAltitudes(flown(6)), true)
    val kept = ScenarioFigure.altitudes(flown(100))
    assert(!texts(kept).exists(_.contains("at most")), texts(kept))
    assertEquals((kept.shapes.count(isRed), ScenarioFigure.hasAltitudes(flown(100))), (0, false))

  test("a curve that begins far above comes in from above, and what it does later is in the panel"):
    // 40 at first, a second of 12, and 1 from then on.
    def value(timeS: Double): Double =
      if timeS < 1 then 40 - 39 * timeS else if timeS > 3 && timeS < 4 then 12 else 1
    val figure         = ScenarioFigure.series(flown(Measured(value)), 0)
    val lines          = figure.shapes.collect { case Mark.Path(points, Some(_), None, _) => points }
    val (grid, curves) = lines.partition(_.size == 2)
    val top            = grid.filter(line => line(0).x == line(1).x).flatten.map(_.y).min
    assertEquals(curves.size, 1)
    assertEqualsDouble(curves.head.map(_.y).min, top, 1e-6)
    assertEqualsDouble(curves.head.head.y, top, 1e-6)
    val ticks = texts(figure).flatMap(_.toDoubleOption)
    assert(ticks.max >= 12 && ticks.max < 40, ticks)

  test("a geofence is cut to the panel, and in the legend if any part is visible"):
    assert(texts(ScenarioFigure.trajectories(flown(100))).contains("geofence"))

object ScenarioFigureSuite:
  final case class Measured(value: Double => Double) extends Scenario:
    def agents: Vector[Agent]           = Crossing(vehicles = 2, streams = 2).agents
    override def series: Vector[Series] = Vector(Series("off", "m")(tracks => at => value(tracks.timeS(at))))

  final case class Capped(ceilingM: Double) extends Scenario:
    def agents: Vector[Agent]          = Crossing(vehicles = 2, streams = 2).agents
    override def limits: Vector[Limit] =
      Vector(Limit.ceiling(Metres(ceilingM)), Limit.geofence(Metres(20), Metres(0), Metres(22)))
