package skein.figures

import skein.measure.{Distribution, PredictionErrors, PredictionGroup}
import skein.plot.*

/** Prediction error by prediction time, a panel per loop and link: medians and 95 % quantiles, each with
  * dashes of its own; of the deciding vehicle itself in colour, of others in grey. A line ends where there
  * are too few measurements; fewer than three adjacent points are drawn as discs, hollow for a 95 % quantile.
  */
object PredictionFigure:
  val name = "prediction"

  def apply(groups: Vector[PredictionGroup]): Option[Drawing] =
    val drawn  = groups.filter(group => kinds.exists(_.of(group).byAge.nonEmpty))
    val panels = drawn.map(panel)
    Option.when(panels.nonEmpty)(Drawing.stacked(
      Drawing.grid(panels, columns = 3.min(panels.size)),
      legend(drawn, kinds.filter(kind => drawn.exists(kind.of(_).byAge.nonEmpty)).reverse)
    ))

  /** A kind of predictions: of the deciding vehicle itself, or of the other vehicles. */
  private final case class Kind(
      name: String,
      colour: Colour,
      dashes: Int,
      of: PredictionGroup => PredictionErrors
  )

  /** The kinds in the order of painting. */
  private val kinds = Vector(
    Kind("others", FlightTheme.evader, 2, _.others),
    Kind("own vehicle", FlightTheme.of("predictive"), 0, _.own)
  )

  /** A quantile of the errors at one age, with its style. */
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
        mark    <- marks(
          panel,
          stretch.map((age, errors) => (age.toDouble, 1000 * share.ofM(errors))),
          share.stroke(kind),
          share.isHollow
        )
      yield mark
    val words = Vector(group.name, FlightTheme.link(group.link), group.scenario).filter(_.nonEmpty)
    val title = panel.fittedTitle(words.mkString(", "))
    Drawing(366, 262, (title +: panel.axes) ++ lines)

  /** Minimum number of points of a curve; fewer are drawn as discs. */
  private val FewestOfCurve = 3

  private def marks(
      panel: Panel,
      points: Vector[(Double, Double)],
      stroke: Stroke,
      isHollow: Boolean
  ): Vector[Mark] =
    if points.sizeIs >= FewestOfCurve then Vector(panel.curve(points, stroke))
    else points.map((x, y) => sign(panel.at(x, y), stroke, isHollow))

  private def sign(at: Point, stroke: Stroke, isHollow: Boolean): Mark =
    if isHollow then Mark.Disc(at, 2.6, Some(Stroke(stroke.colour, 1.2)), Some(FlightTheme.halo))
    else Mark.Disc(at, 2.6, None, Some(stroke.colour))

  /** A legend entry that shows the style of the curve, or of the discs if there are only discs. */
  private def item(groups: Vector[PredictionGroup], kind: Kind, share: Share): Legend.Item =
    val label   = s"${kind.name}, ${share.name}"
    val isCurve = groups.exists(kind.of(_).stretches.exists(_.sizeIs >= FewestOfCurve))
    if isCurve then Legend.line(label, share.stroke(kind))
    else Legend.sign(label)(sign(_, share.stroke(kind), share.isHollow))

  /** The legend, with a row for each kind, so that it is no wider than a panel. */
  private def legend(groups: Vector[PredictionGroup], kinds: Vector[Kind]): Drawing =
    Drawing.stacked(kinds.map(kind => Legend(52, shares.map(item(groups, kind, _))*))*)
