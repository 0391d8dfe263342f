package skein.figures

import java.util.Locale
import skein.measure.ScenarioFlights
import skein.plot.*
import skein.scenario.{Curve, Result, Scenario, Series}

/** Pictures of a scenario's flights: where the vehicles flew, and what it draws over time. */
object ScenarioFigure:
  private val side       = 250.0
  private val plotWidth  = 900.0
  private val plotHeight = 190.0

  /** Every vehicle's way from above (north is up), one panel per flight, all panels of one scale; where a
    * limit was broken the worst, a red ring around each vehicle of it.
    */
  def trajectories(flown: ScenarioFlights): Drawing =
    val tracks = flown.flights.map(_.result.tracks)
    val norths = tracks.flatMap(_.northM.flatten)
    val easts  = tracks.flatMap(_.eastM.flatten)
    val span   = (norths.max - norths.min).max(easts.max - easts.min).max(1) * 1.06
    val east   = PlotAxis.centred("east y, m", easts, span)
    val north  = PlotAxis.centred("north x, m", norths, span)
    val panels = flown.flights.map: flight =>
      val panel = Panel(east, north, 52, 34, side, side)
      val title = panel.title(s"${flight.summary.name}, ${FlightTheme.link(flight.summary.flight.link)}")
      Drawing(
        side + 72,
        side + 82,
        (title +: panel.axes) ++ paths(panel, flight.result) ++ broken(panel, flight.result)
      )
    Drawing.stacked(
      Drawing.grid(panels, columns = 4.min(panels.size)),
      Legend(52, legend(flown)*)
    )

  private def paths(panel: Panel, result: Result): Vector[Mark] =
    val track   = result.tracks
    val strokes = VehicleTheme.of(result.scenario, 1)
    track.vehicles.toVector.flatMap: vehicle =>
      val stroke           = strokes(vehicle)
      val colour           = stroke.colour
      def at(instant: Int) = panel.at(track.eastM(vehicle)(instant), track.northM(vehicle)(instant))
      Vector(
        panel.curve(
          track.eastM(vehicle).toVector.zip(track.northM(vehicle).toVector),
          stroke.copy(colour = colour.faded(0.8))
        ),
        Mark.Disc(at(track.instants.head), 2.8, Some(Stroke(colour, 1.2)), Some(FlightTheme.halo)),
        Mark.Disc(at(track.instants.last), 3, Some(Stroke(FlightTheme.halo, 0.8)), Some(colour))
      )

  private def broken(panel: Panel, result: Result): Vector[Mark] =
    for
      violation <- result.violations
      vehicle   <- violation.vehicles
    yield
      val instant = (violation.worstAtS / result.tracks.stepS).round.toInt
      val place   = panel.at(result.tracks.eastM(vehicle)(instant), result.tracks.northM(vehicle)(instant))
      Mark.Disc(place, 5, Some(Stroke(red, 1.2)))

  /** Every vehicle's altitude over time, one panel per flight, all panels of one scale. */
  def altitudes(flown: ScenarioFlights): Drawing =
    val tracks = flown.flights.map(_.result.tracks)
    val most   = -tracks.flatMap(_.downM.map(_.min)).min
    val least  = -tracks.flatMap(_.downM.map(_.max)).max
    val panels = flown.flights.map: flight =>
      val track = flight.result.tracks
      val panel = Panel(
        PlotAxis.around("time, s", 0, tracks.map(_.lastS).max, 8),
        PlotAxis.around("altitude, m", least.min(0), most),
        52,
        34,
        plotWidth / 2,
        plotHeight
      )
      val strokes = VehicleTheme.of(flight.result.scenario, 1.2)
      val lines   = track.vehicles.toVector.map: vehicle =>
        panel.curve(
          track.instants.map(instant => (track.timeS(instant), track.altitudeM(vehicle, instant))),
          strokes(vehicle)
        )
      val title = panel.title(s"${flight.summary.name}, ${FlightTheme.link(flight.summary.flight.link)}")
      Drawing(plotWidth / 2 + 76, plotHeight + 84, (title +: panel.axes) ++ lines)
    Drawing.stacked(Drawing.grid(panels, columns = 2.min(panels.size)), Legend(52, roles(flown.scenario)*))

  /** What the scenario draws over time, one panel per link, a line per loop, the truth in each.
    *
    * @param index of the scenario's series
    */
  def series(flown: ScenarioFlights, index: Int): Drawing =
    val links = flown.flights.filter(!flown.truth.contains(_)).map(_.summary.flight.link).distinct match
      case Vector() => flown.flights.map(_.summary.flight.link).distinct
      case others   => others
    val strokes = FlightTheme.curves(flown.flights.map(_.summary))
    val panels  = links.map: link =>
      panel(
        link,
        (flown.truth.toVector ++ flown.flights.filter(_.summary.flight.link == link)).distinct,
        index,
        strokes
      )
    Drawing.stacked(panels*)

  private def panel(
      link: String,
      flights: Vector[ScenarioFlights.Flown],
      index: Int,
      strokes: Map[String, Stroke]
  ): Drawing =
    def drawn(flight: ScenarioFlights.Flown): (Series, Curve) = flight.result.curves(index)
    val series                                                = drawn(flights.head)._1
    val bound                                                 = series.bound
    // What is no number at some instants has gaps there.
    val curves  = flights.map(drawn(_)._2.stretches.flatten).filter(_.nonEmpty)
    val highest = (curves.map(highestShown) ++ bound.map(_.value)).maxOption.getOrElse(0.0)
    val panel   = Panel(
      PlotAxis.around("time, s", 0, flights.map(drawn(_)._2.points.last._1).max, 8),
      PlotAxis.around(series.title, (0.0 +: curves.map(_.map(_._2).min)).min, highest),
      left = 52,
      top = 34,
      plotWidth,
      plotHeight
    )
    val lines = flights.flatMap: flight =>
      val stroke    = strokes(flight.summary.name)
      val stretches = drawn(flight)._2.stretches
      (stretches.headOption.map(_.dropWhile(_._2 > panel.y.to)) ++ stretches.drop(1))
        .filter(_.nonEmpty)
        .map:
          case Vector((x, y)) => Mark.Disc(panel.at(x, y), 1.2, None, Some(stroke.colour))
          case several        => panel.curve(several, stroke)
    val held  = bound.map(bound => panel.level(bound.value, boundLine))
    val items =
      FlightTheme.names(flights.map(_.summary), strokes) ++ bound.map(bound =>
        Legend.line(bound.name, boundLine)
      )
    val plot = Drawing(plotWidth + 76, plotHeight + 84, panel.axes ++ held ++ lines)
    Legend.titled(panel, FlightTheme.link(link), plot, items*)

  /** The highest of a curve, but where it begins far above all that follows: then some more than what
    * follows.
    */
  private def highestShown(curve: Vector[(Double, Double)]): Double =
    val highest = curve.map(_._2).max
    val settled = curve.drop(curve.size / 2).map(_._2).max
    if highest > 5 * settled then 2 * settled else highest

  private val red       = Colour(0xcc0000)
  private val boundLine = Stroke(red, 1, Vector(4, 3))

  private def legend(flown: ScenarioFlights): Seq[Legend.Item] =
    val anyBroken = flown.flights.exists(_.result.violations.nonEmpty)
    roles(flown.scenario) ++ Seq(
      disc("start", 2.8, Some(Stroke(Theme.labelColour, 1.2)), Some(FlightTheme.halo)),
      disc("end", 3, None, Some(Theme.labelColour))
    ) ++ Option.when(anyBroken)(disc("a limit broken", 5, Some(Stroke(red, 1.2)), None))

  private def roles(scenario: Scenario): Seq[Legend.Item] =
    val strokes = VehicleTheme.of(scenario, 2.2)
    scenario.agents.map(_.role).distinct.map: role =>
      val same = strokes.zip(scenario.agents).collect { case (stroke, agent) if agent.role == role => stroke }
      val kinds = same.distinct
      val name  = role.name.toLowerCase(Locale.ROOT)
      if same.size == 1 then Legend.line(name, kinds.head)
      else if kinds.size <= MostInLegend then many(s"${name}s", kinds)
      else many(s"${name}s, the first $MostInLegend", kinds.take(MostInLegend))

  private def disc(label: String, radius: Double, edge: Option[Stroke], fill: Option[Colour]): Legend.Item =
    Legend.Item(label, 8, at => Vector(Mark.Disc(at.moved(4, 0), radius, edge, fill)))

  /** Dashed lines are as long as it takes to tell them apart. */
  private def many(label: String, strokes: Vector[Stroke]): Legend.Item =
    val lengths = strokes.map(stroke => if stroke.dash.isEmpty then 11.0 else 27.0)
    val starts  = lengths.scanLeft(0.0)(_ + _ + 6)
    Legend.Item(
      label,
      starts.last - 6,
      at =>
        strokes.zip(starts.zip(lengths)).map: (stroke, place) =>
          Mark.line(at.moved(place._1, 0), at.moved(place._1 + place._2, 0), stroke)
    )

  private val MostInLegend = 12
