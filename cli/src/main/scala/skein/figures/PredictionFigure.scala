package skein.figures

import skein.measure.{Distribution, PredictionErrors, PredictionGroup}
import skein.plot.*

/** Prediction error by how far readings were carried forward, a panel per loop and link: medians as full
  * lines, 95 % quantiles dashed; of the deciding vehicle itself in colour, of others in grey. A line ends
  * where nothing was measured, and what stands alone is a disc, of a 95 % quantile a hollow one.
  */
object PredictionFigure:
  val name = "prediction"

  def apply(groups: Vector[PredictionGroup]): Option[Drawing] =
    val drawn  = groups.filter(group => kinds.exists(_.of(group).byAge.nonEmpty))
    val panels = drawn.map(panel)
    Option.when(panels.nonEmpty)(Drawing.stacked(
      Drawing.grid(panels, columns = 3.min(panels.size)),
      legend(kinds.filter(kind => drawn.exists(kind.of(_).byAge.nonEmpty)).reverse)
    ))

  /** Whose predictions. */
  private final case class Kind(name: String, colour: Colour, of: PredictionGroup => PredictionErrors)

  /** In the order in which they are painted. */
  private val kinds = Vector(
    Kind("others", FlightTheme.evader, _.others),
    Kind("own vehicle", FlightTheme.of("predictive"), _.own)
  )

  /** What is drawn of the errors of one age. */
  private final case class Share(
      name: String,
      ofM: Distribution => Double,
      width: Double,
      dash: Vector[Double]
  )

  private val shares = Vector(
    Share("median", _.median, 1.8, Vector.empty),
    Share("95 %", _.quantile(0.95), 1.4, Vector(4.0, 2.5))
  )

  private def panel(group: PredictionGroup): Drawing =
    val all        = kinds.flatMap(_.of(group).byAge)
    val (from, to) = (all.map(_._1).min, all.map(_._1).max)
    val panel      = Panel(
      PlotAxis.around("carried forward by, ms", from.toDouble, to.toDouble.max(from + 1.0), 5),
      PlotAxis.around("error, mm", 0, 1000 * all.map(_._2.quantile(0.95)).max, 4),
      left = 52,
      top = 34,
      width = 290,
      height = 170
    )
    val lines =
      for
        kind    <- kinds
        share   <- shares
        stretch <- kind.of(group).stretches
      yield line(
        panel,
        stretch.map((age, errors) => (age.toDouble, 1000 * share.ofM(errors))),
        Stroke(kind.colour, share.width, share.dash)
      )
    val title = panel.title(s"${group.name}, ${FlightTheme.link(group.link)}")
    Drawing(366, 262, (title +: panel.axes) ++ lines)

  private def line(panel: Panel, points: Vector[(Double, Double)], stroke: Stroke): Mark = points match
    case Vector((x, y)) if stroke.dash.isEmpty =>
      Mark.Disc(panel.at(x, y), 2.6, None, Some(stroke.colour))
    case Vector((x, y)) =>
      Mark.Disc(panel.at(x, y), 2.6, Some(Stroke(stroke.colour, 1.2)), Some(FlightTheme.halo))
    case several => panel.curve(several, stroke)

  /** A row for each, so that it is no wider than a panel. */
  private def legend(kinds: Vector[Kind]): Drawing = Drawing.stacked(
    kinds.map(kind =>
      Legend(
        52,
        shares.map(share =>
          Legend.line(s"${kind.name}, ${share.name}", Stroke(kind.colour, share.width, share.dash))
        )*
      )
    )*
  )
