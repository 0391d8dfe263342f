package skein.figures

import skein.measure.{FlightSet, FlightSummary}
import skein.plot.*
import skein.policy.Role
import skein.scenario.Track
import skein.units.*

/** The paper's Figures 4 and 5: trajectories seen from above (north is up), one panel per flight, all of one
  * range, with equal scales on both axes. Starts are rings, ends are discs.
  */
object TrajectoryFigure:
  private val side = 210.0

  def apply(set: FlightSet): Option[Drawing] =
    val flights = set.flights.filter(_.tracks.nonEmpty)
    Option.when(flights.nonEmpty):
      val positions = flights.flatMap(_.tracks.flatMap(_.positionsNed))
      val xs        = positions.map(_.x)
      val ys        = positions.map(_.y)
      // Equal scales: both axes span the larger of the two extents, each around its own middle.
      val span  = (xs.max - xs.min).max(ys.max - ys.min).max(1) * 1.08
      val east  = PlotAxis.centred("east y, m", ys, span)
      val north = PlotAxis.centred("north x, m", xs, span)
      Drawing.stacked(
        Drawing.grid(flights.map(panel(_, east, north)), columns = 4.min(flights.size)),
        legend(set)
      )

  private def panel(summary: FlightSummary, east: PlotAxis, north: PlotAxis): Drawing =
    val panel = Panel(east, north, 52, 34, side, side)
    val title = panel.fittedTitle(s"${summary.name}, ${FlightTheme.link(summary.flight.link)}")
    Drawing(
      side + 72,
      side + 82,
      (title +: panel.axes) ++ summary.tracks.sortBy(_.role).flatMap(path(panel, summary, _))
    )

  private def path(panel: Panel, summary: FlightSummary, track: Track): Vector[Mark] =
    val colour = if track.isA(Role.Pursuer) then FlightTheme.of(summary.flight.loop) else FlightTheme.evader
    def at(p: Vector3) = panel.at(p.y, p.x)
    Vector(
      panel.curve(track.positionsNed.map(p => (p.y, p.x)), Stroke(colour.faded(0.85), 1.1)),
      start(at(track.positionsNed.head), colour),
      end(at(track.positionsNed.last), colour)
    )

  private def legend(set: FlightSet): Drawing =
    val loops = set.flights.map(_.flight.loop).distinct
    Legend(
      52,
      Legend.Item(
        "pursuer",
        loops.size * 9,
        at =>
          loops.indices.toVector.map(index =>
            val colour = FlightTheme.of(loops(index))
            Mark.line(at.moved(index * 9, 0), at.moved(index * 9 + 8, 0), thick(colour))
          )
      ),
      Legend.line("evader", thick(FlightTheme.evader)),
      Legend.sign("start")(start(_, Theme.labelColour)),
      Legend.sign("end")(end(_, Theme.labelColour))
    )

  private def thick(colour: Colour): Stroke = FlightTheme.line(colour, 2.2)

  private def start(at: Point, colour: Colour): Mark =
    Mark.Disc(at, 3.4, Some(Stroke(colour, 1.4)), Some(FlightTheme.halo))

  private def end(at: Point, colour: Colour): Mark =
    Mark.Disc(at, 3.6, Some(Stroke(FlightTheme.halo, 0.8)), Some(colour))
