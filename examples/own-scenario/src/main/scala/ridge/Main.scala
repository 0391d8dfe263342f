package ridge

import skein.cli.SkeinApp
import skein.figures.Figure
import skein.measure.FlightSet
import skein.plot.*
import skein.report.ScenarioReport
import skein.scenario.ScenarioKind

/** All of Skein's commands for the ridge: `./sbtw "ownScenario/run fly --clock virtual"`. */
object Main extends SkeinApp(RidgeKind)

/** The scenario with a picture of its own: trajectories from the side, over the ground. */
object RidgeKind extends ScenarioKind(OverTheRidge()), ScenarioReport:
  override def figures(set: FlightSet): Vector[Figure] = super.figures(set) ++ set.scenarios.map: flown =>
    val panels = flown.flights.map: flight =>
      val tracks = flight.result.tracks
      val land   = flown.scenario match
        case ridge: OverTheRidge => Land(60, ridge.crestM, ridge.widthM)
        case _                   => Land(0, 0, 1)
      val panel =
        Panel(
          PlotAxis.exactly("north, m", -20, 130, 8),
          PlotAxis.exactly("altitude, m", 0, 50),
          52,
          34,
          560,
          187
        )
      val ground = panel.curve(
        (-20 to 130).map(north => (north.toDouble, land.heightM(north))),
        Stroke(Colour(0x8c6d46), 2)
      )
      // The first one is wider, and so is seen where both fly one way.
      def line(scout: Int) =
        if scout == 0 then Stroke(Colour(0x56b4e9), 4) else Stroke(Colour(0xd55e00), 1.4)
      val ways = tracks.vehicles.toVector.map(scout =>
        panel.curve(
          tracks.instants.map(now => (tracks.northM(scout)(now), tracks.altitudeM(scout, now))),
          line(scout)
        )
      )
      Legend.titled(
        panel,
        s"${flight.summary.name}, ${flight.summary.flight.link}",
        Drawing(640, 270, panel.axes ++ (ground +: ways)),
        tracks.vehicles.map(scout => Legend.line(s"scout ${scout + 1}", line(scout)))*
      )
    Figure("ridge", "From the side", "The ground in brown, a line for each scout.", Drawing.stacked(panels*))
