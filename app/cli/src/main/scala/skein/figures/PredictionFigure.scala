package skein.figures

import skein.measure.{Distribution, PredictionErrors, PredictionGroup}
import skein.plot.*

/** Prediction error by how far readings were carried forward, a panel per loop and link: medians and 95 %
  * quantiles, each with dashes of its own; of the deciding vehicle itself in colour, of others in grey. A
  * line ends where nothing was measured, and what stands alone is a disc, of a 95 % quantile a hollow one.
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
  private final case class Kind(
      name: String,
      colour: Colour,
      dashes: Int,
      of: PredictionGroup => PredictionErrors
  )

  /** In the order in which they are painted. */
  private val kinds = Vector(
    Kind("others", FlightTheme.evader, 2, _.others),
    Kind("own vehicle", FlightTheme.of("predictive"), 0, _.own)
  )

  /** What is drawn of the errors of one age. */
  private final case class Share(
      name: String,
      ofM: Distribution => Double,
      width: Double,
      dashes: Int,
      isHollow: Boolean
  ):
    def stroke(kind: Kind): Stroke = Stroke(kind.colour, width).dashed(kind.dashes + dashes)

  private val shares = Vector(
    Share("median", _.median, 1.8, 0, isHollow = false),
    Share("95 %", _.quantile(0.95), 1.4, 1, isHollow = true)
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
        share.stroke(kind),
        share.isHollow
      )
    val title = panel.title(s"${group.name}, ${FlightTheme.link(group.link)}")
    Drawing(366, 262, (title +: panel.axes) ++ lines)

  private def line(
      panel: Panel,
      points: Vector[(Double, Double)],
      stroke: Stroke,
      isHollow: Boolean
  ): Mark = points match
    case Vector((x, y)) if isHollow =>
      Mark.Disc(panel.at(x, y), 2.6, Some(Stroke(stroke.colour, 1.2)), Some(FlightTheme.halo))
    case Vector((x, y)) => Mark.Disc(panel.at(x, y), 2.6, None, Some(stroke.colour))
    case several        => panel.curve(several, stroke)

  /** A row for each, so that it is no wider than a panel. */
  private def legend(kinds: Vector[Kind]): Drawing = Drawing.stacked(
    kinds.map(kind =>
      Legend(
        52,
        shares.map(share =>
          Legend.line(s"${kind.name}, ${share.name}", share.stroke(kind))
        )*
      )
    )*
  )
