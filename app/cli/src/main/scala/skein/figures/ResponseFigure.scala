package skein.figures

import skein.identify.TimeHistory
import skein.plot.*
import skein.vehicle.{ObservedPlant, PlantFlight}

/** Fit of a model to measurements: per vehicle the velocity north and east, measured as dots and modelled as
  * a line, east's dashed, and below the residuals. The model is simulated from the first reading to the last,
  * with only the commands as input.
  */
object ResponseFigure:
  private val width    = 620.0
  private val height   = 150.0
  private val residual = 70.0

  private val north = Stroke(Colour(0x0072b2), 1.1)
  private val east  = Stroke(Colour(0xd55e00), 1.1).dashed(1)

  def apply(model: ObservedPlant[?], flights: Vector[TimeHistory]): Drawing =
    val panels = flights.filter(_.samples.sizeIs > 1).map(panel(model, _))
    Drawing.stacked(Drawing.grid(panels, columns = 2), legend)

  private def panel(model: ObservedPlant[?], flown: TimeHistory): Drawing =
    val modelled = flight(model, flown)
    val samples  = flown.samples
    val time   = PlotAxis.exactly("time, s", samples.head.atS, samples.last.atS.max(samples.head.atS + 1), 6)
    val speeds = samples.flatMap(sample => Vector(sample.vx, sample.vy))
    val top    =
      Panel(
        time.copy(label = ""),
        PlotAxis.around("velocity, m/s", speeds.min, speeds.max),
        52,
        34,
        width,
        height
      )
    val remains =
      samples.zip(modelled).flatMap((sample, model) => Vector(sample.vx - model._1, sample.vy - model._2))
    val most  = remains.map(math.abs).max.max(0.05)
    val below =
      Panel(time, PlotAxis.around("residual, m/s", -most, most, 3), 52, top.bottom + 26, width, residual)
    val shapes =
      for
        (stroke, measured, model) <- Vector(
          (north, samples.map(_.vx), modelled.map(_._1)),
          (east, samples.map(_.vy), modelled.map(_._2))
        )
        shape <- dots(top, samples.map(_.atS).zip(measured), stroke.colour) ++ Vector(
          top.curve(samples.map(_.atS).zip(model), stroke),
          below.curve(
            samples.map(_.atS).zip(measured.zip(model).map(_ - _)),
            stroke.copy(colour = stroke.colour.faded(0.8), width = 0.9)
          )
        )
      yield shape
    val rms = math.sqrt(remains.map(r => r * r).sum / remains.size)
    Drawing(
      width + 72,
      below.bottom + 44,
      (top.title(f"${flown.name}: residual $rms%.3f m/s rms") +: top.axes) ++ below.axes ++ shapes
    )

  private def dots(panel: Panel, values: Vector[(Double, Double)], colour: Colour): Vector[Mark] =
    values.map((at, value) => Mark.Disc(panel.at(at, value), 1.3, None, Some(colour.faded(0.45))))

  /** The modelled velocity at the time of every sample. */
  private def flight[S](model: ObservedPlant[S], flown: TimeHistory): Vector[(Double, Double)] =
    val start    = flown.samples.head
    val modelled = Vector.newBuilder[(Double, Double)]
    modelled += ((start.vx, start.vy))
    val flight = PlantFlight(model)
    flown.predict(flight, model.corrected(model.initial, start.reading), 0, Double.PositiveInfinity): _ =>
      val predicted = flight.reading
      modelled += ((predicted.northMps, predicted.eastMps))
    modelled.result()

  private def legend: Drawing =
    def dot(label: String, colour: Colour) =
      Legend.sign(label)(Mark.Disc(_, 2.4, None, Some(colour.faded(0.6))))
    Legend(
      52,
      dot("north, measured", north.colour),
      Legend.line("north, modelled", north.copy(width = 1.6)),
      dot("east, measured", east.colour),
      Legend.line("east, modelled", east.copy(width = 1.6))
    )
