package skein.figures

import skein.measure.PredictionGroup
import skein.plot.*

/** Prediction error against age, a panel per loop and link: medians as full lines, 95 % quantiles dashed; of
  * the deciding vehicle itself in the loop's colour, of others in grey.
  */
object PredictionFigure:
  val name = "prediction"

  def apply(groups: Vector[PredictionGroup]): Option[Drawing] =
    val panels = groups.filter(group => group.own.byAge.nonEmpty || group.others.byAge.nonEmpty).map(panel)
    Option.when(panels.nonEmpty)(Drawing.stacked(Drawing.grid(panels, columns = 3.min(panels.size)), legend))

  private def panel(group: PredictionGroup): Drawing =
    val curves =
      Vector(group.others.byAge -> FlightTheme.evader, group.own.byAge -> FlightTheme.of("predictive"))
    val all        = curves.flatMap(_._1)
    val (from, to) = (all.map(_._1).min, all.map(_._1).max)
    val panel      = Panel(
      PlotAxis.around("carried forward by, ms", from.toDouble, to.toDouble.max(from + 1.0), 5),
      PlotAxis.around("error, mm", 0, 1000 * all.map(_._2.quantile(0.95)).max, 4),
      left = 52,
      top = 34,
      width = 290,
      height = 170
    )
    val lines = curves.flatMap: (bins, colour) =>
      Vector(
        curve(panel, bins.map((age, errors) => (age.toDouble, 1000 * errors.median)), Stroke(colour, 1.8)),
        curve(
          panel,
          bins.map((age, errors) => (age.toDouble, 1000 * errors.quantile(0.95))),
          Stroke(colour, 1.4, dashes)
        )
      ).flatten
    val title = panel.title(s"${group.name}, ${FlightTheme.link(group.link)}")
    Drawing(366, 262, (title +: panel.axes) ++ lines)

  /** A single age is a disc. */
  private def curve(panel: Panel, points: Vector[(Double, Double)], stroke: Stroke): Vector[Mark] =
    points match
      case Vector()       => Vector.empty
      case Vector((x, y)) => Vector(Mark.Disc(panel.at(x, y), 2.6, None, Some(stroke.colour)))
      case several        => Vector(panel.curve(several, stroke))

  private val dashes = Vector(4.0, 2.5)

  private def legend: Drawing =
    Legend(
      52,
      Legend.line("own vehicle, median", Stroke(FlightTheme.of("predictive"), 1.8)),
      Legend.line("95 %", Stroke(FlightTheme.of("predictive"), 1.4, dashes)),
      Legend.line("opponent, median", Stroke(FlightTheme.evader, 1.8)),
      Legend.line("95 %", Stroke(FlightTheme.evader, 1.4, dashes))
    )
