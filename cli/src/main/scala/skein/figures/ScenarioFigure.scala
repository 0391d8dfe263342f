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
    val track = result.tracks
    track.vehicles.toVector.flatMap: vehicle =>
      val colour           = colourOf(result.scenario, vehicle)
      def at(instant: Int) = panel.at(track.eastM(vehicle)(instant), track.northM(vehicle)(instant))
      Vector(
        panel.curve(
          track.eastM(vehicle).toVector.zip(track.northM(vehicle).toVector),
          Stroke(colour.faded(0.8), 1)
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
      val lines = track.vehicles.toVector.map: vehicle =>
        panel.curve(
          track.instants.map(instant => (track.timeS(instant), track.altitudeM(vehicle, instant))),
          Stroke(colourOf(flight.result.scenario, vehicle), 1.2)
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
    val panels = links.map: link =>
      panel(
        link,
        (flown.truth.toVector ++ flown.flights.filter(_.summary.flight.link == link)).distinct,
        index
      )
    Drawing.stacked(panels*)

  private def panel(link: String, flights: Vector[ScenarioFlights.Flown], index: Int): Drawing =
    def drawn(flight: ScenarioFlights.Flown): (Series, Curve) = flight.result.curves(index)
    val series                                                = drawn(flights.head)._1
    val bound                                                 = series.bound
    val curves                                                = flights.map(drawn(_)._2.points)
    val highest = (curves.map(highestShown) ++ bound.map(_.value)).max
    val panel   = Panel(
      PlotAxis.around("time, s", 0, curves.map(_.last._1).max, 8),
      PlotAxis.around(series.title, (0.0 +: curves.map(_.map(_._2).min)).min, highest),
      left = 52,
      top = 34,
      plotWidth,
      plotHeight
    )
    val lines = flights.map(flight =>
      panel.curve(drawn(flight)._2.points.dropWhile(_._2 > panel.y.to), FlightTheme.of(flight.summary))
    )
    val held  = bound.map(bound => panel.level(bound.value, boundLine))
    val items =
      FlightTheme.names(flights.map(_.summary)) ++ bound.map(bound => Legend.line(bound.name, boundLine))
    Drawing(
      plotWidth + 76,
      plotHeight + 84,
      (panel.title(FlightTheme.link(link)) +: panel.axes) ++ held ++ lines ++ Legend.above(panel, items*)
    )

  /** The highest of a curve, but where it begins far above all that follows: then some more than what
    * follows.
    */
  private def highestShown(curve: Vector[(Double, Double)]): Double =
    val highest = curve.map(_._2).max
    val settled = curve.drop(curve.size / 2).map(_._2).max
    if highest > 5 * settled then 2 * settled else highest

  private val red       = Colour(0xcc0000)
  private val boundLine = Stroke(red, 1, Vector(4, 3))

  /** Okabe and Ito's, as for the loops: here by what a vehicle is to the others. */
  private val colours = Vector(0x0072b2, 0xd55e00, 0x009e73, 0xaa4499).map(Colour(_))
  private val lead    = Colour(0x404040)

  /** Of one alone in its role among others grey. */
  private def colourOf(scenario: Scenario, vehicle: Int): Colour =
    if isAlone(scenario, vehicle) then lead else colours(scenario.shade(vehicle) % colours.size)

  private def isAlone(scenario: Scenario, vehicle: Int) =
    scenario.agents.sizeIs > 1 && scenario.agents.count(_.role == scenario.agents(vehicle).role) == 1

  private def legend(flown: ScenarioFlights): Seq[Legend.Item] =
    val anyBroken = flown.flights.exists(_.result.violations.nonEmpty)
    roles(flown.scenario) ++ Seq(
      disc("start", 2.8, Some(Stroke(Theme.labelColour, 1.2)), Some(FlightTheme.halo)),
      disc("end", 3, None, Some(Theme.labelColour))
    ) ++ Option.when(anyBroken)(disc("a limit broken", 5, Some(Stroke(red, 1.2)), None))

  private def roles(scenario: Scenario): Seq[Legend.Item] =
    val places = scenario.agents.indices
    places.map(scenario.agents(_).role).distinct.map: role =>
      val same = places.filter(scenario.agents(_).role == role)
      val name = role.name.toLowerCase(Locale.ROOT)
      if isAlone(scenario, same.head) then Legend.line(name, Stroke(lead, 2.2))
      else
        many(
          if same.size == 1 then name else s"${name}s",
          same.map(scenario.shade).distinct.size.min(colours.size)
        )

  private def disc(label: String, radius: Double, edge: Option[Stroke], fill: Option[Colour]): Legend.Item =
    Legend.Item(label, 8, at => Vector(Mark.Disc(at.moved(4, 0), radius, edge, fill)))

  private def many(label: String, count: Int): Legend.Item = Legend.Item(
    label,
    count * 9.0,
    at =>
      Vector.tabulate(count)(index =>
        Mark.line(at.moved(index * 9, 0), at.moved(index * 9 + 8, 0), Stroke(colours(index), 2.2))
      )
  )
