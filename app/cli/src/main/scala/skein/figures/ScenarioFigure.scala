package skein.figures

import java.util.Locale
import skein.measure.ScenarioFlights
import skein.plot.*
import skein.scenario.{Curve, Fence, Kept, Limit, Result, Scenario, Series}

/** Pictures of a scenario's flights: trajectories, and its series over time. */
object ScenarioFigure:
  private val side       = 250.0
  private val plotWidth  = 900.0
  private val plotHeight = 190.0

  /** Trajectories from above (north is up), one panel per flight, all panels of one scale; where a limit was
    * broken, the worst violation has a red ring around each vehicle involved.
    */
  def trajectories(flown: ScenarioFlights): Drawing =
    val tracks = flown.flights.map(_.result.tracks)
    val norths = tracks.flatMap(_.northM.flatten)
    val easts  = tracks.flatMap(_.eastM.flatten)
    val span   = (norths.max - norths.min).max(easts.max - easts.min).max(1) * 1.06
    val east   = PlotAxis.centred("east y, m", easts, span)
    val north  = PlotAxis.centred("north x, m", norths, span)
    val fences = flown.scenario.limits.flatMap(_.kept).collect { case Kept.Inside(fence) => fence }
    def fence(panel: Panel) = fences.flatMap(outline(panel, _))
    val panels              = flown.flights.map: flight =>
      val panel = Panel(east, north, 52, 34, side, side)
      val title =
        panel.fittedTitle(s"${flight.summary.name}, ${FlightTheme.link(flight.summary.flight.link)}")
      Drawing(
        side + 72,
        side + 82,
        (title +: panel.axes) ++ fence(panel) ++ paths(panel, flight.result) ++ broken(panel, flight.result)
      )
    val grid     = Drawing.grid(panels, columns = 4.min(panels.size))
    val isFenced = fence(Panel(east, north, 0, 0, side, side)).nonEmpty
    Drawing.stacked(
      grid,
      Legend.rows(
        52,
        grid.width - 52,
        (legend(flown) ++ Option.when(isFenced)(Legend.line("geofence", boundLine)))*
      )
    )

  /** The outline of a fence, clipped to the panel. */
  private def outline(panel: Panel, fence: Fence): Vector[Mark] =
    val corners = fence match
      case Fence.Circle(north, east, radius) =>
        Vector.tabulate(181): degree =>
          val angle = math.toRadians(2.0 * degree)
          (north + radius * math.cos(angle), east + radius * math.sin(angle))
      case Fence.Polygon(corners) => corners :+ corners.head
    val fine = corners.zip(corners.drop(1)).flatMap { case ((n0, e0), (n1, e1)) =>
      Vector.tabulate(50)(step => (n0 + (n1 - n0) * step / 50, e0 + (e1 - e0) * step / 50))
    } :+ corners.last
    def isIn(at: (Double, Double)) =
      at._1 >= panel.y.from && at._1 <= panel.y.to && at._2 >= panel.x.from && at._2 <= panel.x.to
    Vector
      .unfold(fine): left =>
        val (stretch, rest) = left.dropWhile(!isIn(_)).span(isIn)
        Option.when(stretch.nonEmpty)((stretch, rest))
      .map(stretch => panel.curve(stretch.map(_.swap), boundLine))

  private def paths(panel: Panel, result: Result): Vector[Mark] =
    val track   = result.tracks
    val strokes = layered(result.scenario, 1)
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

  /** Lines that get thinner from vehicle to vehicle, so that coinciding trajectories all stay visible. */
  private def layered(scenario: Scenario, width: Double): Vector[Stroke] =
    val strokes = VehicleTheme.of(scenario, width)
    if strokes.sizeIs > MostNamed then strokes
    else
      strokes.zipWithIndex.map: (stroke, vehicle) =>
        stroke.copy(width = width + WidestMore * (strokes.size - 1 - vehicle) / (strokes.size - 1).max(1))

  private def broken(panel: Panel, result: Result): Vector[Mark] =
    for
      violation <- result.violations
      vehicle   <- violation.vehicles
    yield
      val instant = (violation.worstAtS / result.tracks.stepS).round.toInt
      val place   = panel.at(result.tracks.eastM(vehicle)(instant), result.tracks.northM(vehicle)(instant))
      Mark.Disc(place, 5, Some(Stroke(red, 1.2)))

  /** Whether altitudes vary, or are limited. */
  def hasAltitudes(flown: ScenarioFlights): Boolean =
    !flown.scenario.isPlanar || flown.flights.exists(_.result.violations.exists(at =>
      altitudeOf(at.limit).isDefined
    ))

  private def altitudeOf(limit: Limit): Option[Double] = limit.kept.collect:
    case Kept.Above(least) => least
    case Kept.Below(most)  => most

  /** Altitudes over time, one panel per flight, all panels of one scale; altitude limits where they were
    * broken or are near, and a red ring at the worst violation.
    */
  def altitudes(flown: ScenarioFlights): Drawing =
    val tracks = flown.flights.map(_.result.tracks)
    val broken = flown.flights.flatMap(_.result.violations).map(_.limit).distinct
    val most   = (-tracks.flatMap(_.downM.map(_.min)).min +: broken.flatMap(altitudeOf)).max
    val least  = (-tracks.flatMap(_.downM.map(_.max)).max +: broken.flatMap(altitudeOf)).min.min(0)
    val axis   = PlotAxis.around("altitude, m", least, most)
    val near   = flown.scenario.limits.filter(altitudeOf(_).exists(at => at >= axis.from && at <= axis.to))
    val panels = flown.flights.map: flight =>
      val track = flight.result.tracks
      val panel = Panel(
        PlotAxis.around("time, s", 0, tracks.map(_.lastS).max, 8),
        axis,
        52,
        34,
        plotWidth / 2,
        plotHeight
      )
      val strokes = layered(flight.result.scenario, 1.2)
      val lines   = track.vehicles.toVector.map: vehicle =>
        panel.curve(
          track.instants.map(instant => (track.timeS(instant), track.altitudeM(vehicle, instant))),
          strokes(vehicle)
        )
      val rings = flight.result.violations.filter(at => altitudeOf(at.limit).isDefined).map: violation =>
        Mark.Disc(panel.at(violation.worstAtS, violation.worst), 5, Some(Stroke(red, 1.2)))
      val held  = near.flatMap(altitudeOf).map(panel.level(_, boundLine))
      val title =
        panel.fittedTitle(s"${flight.summary.name}, ${FlightTheme.link(flight.summary.flight.link)}")
      Drawing(plotWidth / 2 + 76, plotHeight + 84, (title +: panel.axes) ++ held ++ lines ++ rings)
    val grid  = Drawing.grid(panels, columns = 2.min(panels.size))
    val items = vehicles(flown.scenario) ++ near.map(limit => Legend.line(limit.text, boundLine)) ++
      Option.when(broken.exists(altitudeOf(_).isDefined))(brokenItem)
    Drawing.stacked(grid, Legend.rows(52, grid.width - 52, items*))

  /** One of a scenario's series over time: a panel for each link, with a line for each loop and one for the
    * paused flight.
    *
    * @param index index of the drawn series among the scenario's series
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
    // A curve has gaps where its value is NaN.
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
      val stroke = strokes(flight.summary.name)
      drawn(flight)._2.stretches.flatMap:
        case Vector((x, y)) if y <= panel.y.to =>
          Vector(Mark.Disc(panel.at(x, y), 1.2, None, Some(stroke.colour)))
        case several => panel.cut(several, stroke)
    val held  = bound.map(bound => panel.level(bound.value, boundLine))
    val seen  = flights.filter(drawn(_)._2.stretches.nonEmpty)
    val items =
      FlightTheme.names(seen.map(_.summary), strokes) ++ bound.map(bound =>
        Legend.line(bound.name, boundLine)
      )
    val plot = Drawing(plotWidth + 76, plotHeight + 84, panel.axes ++ held ++ lines)
    Legend.titled(panel, FlightTheme.link(link), plot, items*)

  /** The maximum value of a curve. Of one that begins far above its second half, the greatest after it has
    * fallen to twice that half's: it comes into the picture from above.
    */
  private def highestShown(curve: Vector[(Double, Double)]): Double =
    val settled = curve.drop(curve.size / 2).map(_._2).max
    val isAbove = settled >= 0 && curve.map(_._2).max > 5 * settled
    (if isAbove then curve.dropWhile(_._2 > 2 * settled) else curve).map(_._2).max

  private val red       = Colour(0xcc0000)
  private val boundLine = Stroke(red, 1, Vector(4, 3))

  private def legend(flown: ScenarioFlights): Seq[Legend.Item] =
    val anyBroken = flown.flights.exists(_.result.violations.nonEmpty)
    vehicles(flown.scenario) ++ Seq(
      disc("start", 2.8, Some(Stroke(Theme.labelColour, 1.2)), Some(FlightTheme.halo)),
      disc("end", 3, None, Some(Theme.labelColour))
    ) ++ Option.when(anyBroken)(brokenItem)

  private def brokenItem = disc("a limit broken", 5, Some(Stroke(red, 1.2)), None)

  /** Legend of the vehicles: by name if few, else by role. */
  private[figures] def vehicles(scenario: Scenario): Seq[Legend.Item] =
    if scenario.agents.sizeIs > MostNamed then roles(scenario)
    else scenario.agents.zip(layered(scenario, 1.6)).map((agent, stroke) => Legend.line(agent.name, stroke))

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
    Legend.sign(label)(Mark.Disc(_, radius, edge, fill))

  /** A legend entry of several lines; dashed lines are long enough to be distinguished. */
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

  /** Maximum number of vehicles that a legend lists by name. */
  private val MostNamed = 8

  /** How much wider the first vehicle's line is than the last vehicle's. */
  private val WidestMore = 3.0
