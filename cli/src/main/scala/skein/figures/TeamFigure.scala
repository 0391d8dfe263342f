package skein.figures

import skein.measure.{TeamFlights, TeamResult}
import skein.plot.*
import skein.policy.TeamScenario

/** Pictures of teams' flights: where the vehicles flew, and the scenario's measure over time. */
object TeamFigure:
  private val side       = 250.0
  private val plotWidth  = 900.0
  private val plotHeight = 190.0

  /** Every vehicle's way from above (north is up), one panel per flight, all panels of one scale. */
  def trajectories(flown: TeamFlights): Drawing =
    val tracks = flown.flights.map(_.result.track)
    val norths = tracks.flatMap(_.northM.flatten)
    val easts  = tracks.flatMap(_.eastM.flatten)
    val span   = (norths.max - norths.min).max(easts.max - easts.min).max(1) * 1.06
    def axis(label: String, values: Vector[Double]) =
      val middle = (values.min + values.max) / 2
      Axis.exactly(label, middle - span / 2, middle + span / 2)
    val panels = flown.flights.map: flight =>
      val panel = Panel(axis("east y, m", easts), axis("north x, m", norths), 52, 34, side, side)
      val title =
        panel.title(s"${flight.summary.flight.loop}, ${Looks.link(flight.summary.flight.link)}")
      Drawing(side + 72, side + 82, (title +: panel.axes) ++ paths(panel, flight.result))
    Drawing.stacked(
      Drawing.grid(panels, columns = 4.min(panels.size)),
      Legend(52, legend(flown.flights.head.result.scenario)*)
    )

  private def paths(panel: Panel, result: TeamResult): Vector[Shape] =
    val track = result.track
    track.vehicles.toVector.flatMap: vehicle =>
      val colour           = colourOf(result.scenario, vehicle)
      def at(instant: Int) = panel.at(track.eastM(vehicle)(instant), track.northM(vehicle)(instant))
      Vector(
        panel.curve(
          track.eastM(vehicle).toVector.zip(track.northM(vehicle).toVector),
          Stroke(colour.faded(0.8), 1)
        ),
        Shape.Disc(at(track.instants.head), 2.8, Some(Stroke(colour, 1.2)), Some(Looks.halo)),
        Shape.Disc(at(track.instants.last), 3, Some(Stroke(Looks.halo, 0.8)), Some(colour))
      )

  /** The scenario's measure over time, one panel per link, a line per loop, the truth in each. */
  def measure(flown: TeamFlights): Drawing =
    val links = flown.flights.filter(!flown.truth.contains(_)).map(_.summary.flight.link).distinct match
      case Vector() => flown.flights.map(_.summary.flight.link).distinct
      case others   => others
    val panels = links.map: link =>
      panel(link, (flown.truth.toVector ++ flown.flights.filter(_.summary.flight.link == link)).distinct)
    Drawing.stacked(panels*)

  private def panel(link: String, flights: Vector[TeamFlights.Flown]): Drawing =
    val first   = flights.head.result
    val curves  = flights.map(_.result.curve)
    val highest = (curves.map(highestShown) ++ first.bound).max
    val panel   = Panel(
      Axis.around("time, s", 0, curves.map(_.last._1).max, 8),
      Axis.around(s"${first.curveName}, m", 0, highest),
      left = 52,
      top = 34,
      plotWidth,
      plotHeight
    )
    val lines = flights.map(flight =>
      panel.curve(
        flight.result.curve.dropWhile(_._2 > panel.y.to),
        Looks.line(Looks.of(flight.summary.flight.loop))
      )
    )
    val bound = first.bound.map: value =>
      Shape.line(Point(panel.left, panel.atY(value)), Point(panel.right, panel.atY(value)), boundLine)
    val items = flights.map(_.summary.flight.loop).distinct.map(loop =>
      Legend.line(loop, Looks.line(Looks.of(loop), 2.2))
    ) ++ first.bound.map(_ => Legend.line(boundName(first.scenario), boundLine))
    val legend = Legend(0, items*)
    Drawing(
      plotWidth + 76,
      plotHeight + 84,
      (panel.title(Looks.link(link)) +: panel.axes) ++ bound ++ lines ++
        legend.shapes.map(_.moved(panel.right - legend.width, panel.top - 23))
    )

  /** The highest of a curve, but where it begins far above all that follows: then some more than what follows. */
  private def highestShown(curve: Vector[(Double, Double)]): Double =
    val highest = curve.map(_._2).max
    val settled = curve.drop(curve.size / 2).map(_._2).max
    if highest > 5 * settled then 2 * settled else highest

  private def boundName(scenario: TeamScenario): String = scenario match
    case _: TeamScenario.Crossing => "set minimum"
    case _                        => "asked for"

  private val boundLine = Stroke(Colour(0xcc0000), 1, Vector(4, 3))

  /** Okabe and Ito's, as for the loops: here by what a vehicle is to the others. */
  private val colours = Vector(0x0072b2, 0xd55e00, 0x009e73, 0xaa4499).map(Colour(_))
  private val lead    = Colour(0x404040)

  private def colourOf(scenario: TeamScenario, vehicle: Int): Colour = scenario match
    case crossing: TeamScenario.Crossing => colours(vehicle % crossing.streams)
    case _ => if vehicle == 0 then lead else colours((vehicle - 1) % colours.size)

  private def legend(scenario: TeamScenario): Seq[Legend.Item] =
    val vehicles = scenario match
      case _: TeamScenario.Surround  => Seq(Legend.line("evader", Stroke(lead, 2.2)), many("pursuers", 4))
      case _: TeamScenario.Formation => Seq(Legend.line("leader", Stroke(lead, 2.2)), many("followers", 4))
      case crossing: TeamScenario.Crossing => Seq(many("vehicles, by stream", crossing.streams))
    vehicles ++ Seq(
      Legend.Item(
        "start",
        8,
        at => Vector(Shape.Disc(at.moved(4, 0), 2.8, Some(Stroke(Ink.labelColour, 1.2)), Some(Looks.halo)))
      ),
      Legend.Item("end", 8, at => Vector(Shape.Disc(at.moved(4, 0), 3, None, Some(Ink.labelColour))))
    )

  private def many(label: String, count: Int): Legend.Item = Legend.Item(
    label,
    count * 9.0,
    at =>
      Vector.tabulate(count)(index =>
        Shape.line(at.moved(index * 9, 0), at.moved(index * 9 + 8, 0), Stroke(colours(index), 2.2))
      )
  )
