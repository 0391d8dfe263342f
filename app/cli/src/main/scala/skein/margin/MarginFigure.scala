package skein.margin

import skein.optimise.LatencyBudget.Bound
import skein.plot.*

/** The measure against the links' mean round trips, with 95 % intervals, the tolerance as a band, and the
  * margin.
  */
object MarginFigure:
  private val measured  = Colour(0x0072b2)
  private val tolerated = Colour(0x009e73).faded(0.15)
  private val left      = Stroke(Colour(0xd55e00), 1.8)

  def apply(curve: MarginCurve): Drawing =
    val points                   = (curve.reference +: curve.points).filter(_.stats.count > 0)
    val judge                    = curve.judge
    val around                   = curve.tolerance.value * curve.per
    val middle                   = curve.reference.stats.mean
    def half(point: MarginPoint) =
      Some(point.stats.halfWidth95).filter(_.isFinite).getOrElse(0.0)
    val values = points.flatMap(point =>
      Vector(point.stats.mean - half(point), point.stats.mean + half(point))
    ) ++ Vector(middle - around, middle + around)
    val panel = Panel(
      PlotAxis.around("mean round trip of the link, ms", 0, points.map(_.meanMs).max.max(1)),
      PlotAxis.around(s"${judge.name}, ${judge.unit}".stripSuffix(", "), values.min, values.max),
      left = 62,
      top = 52,
      width = 560,
      height = 300
    )
    val band = Mark.box(
      panel.left,
      panel.atY(middle + around),
      panel.right,
      panel.atY(middle - around),
      tolerated
    )
    val line  = Stroke(measured, 2)
    val spans = points.filter(half(_) > 0).map: point =>
      val (mean, off) = (point.stats.mean, half(point))
      Mark.line(panel.at(point.meanMs, mean - off), panel.at(point.meanMs, mean + off), Stroke(measured, 1.2))
    val discs = points.map(point =>
      Mark.Disc(panel.at(point.meanMs, point.stats.mean), 3.5, None, Some(measured))
    )
    val found = curve.margin match
      case Bound.At(ms) => Vector(panel.upright(ms, left))
      case _            => Vector.empty
    Legend.between(
      panel,
      s"${judge.name} of the program",
      (band +: panel.axes) ++ spans ++
        Vector(panel.curve(points.map(point => (point.meanMs, point.stats.mean)), line)) ++ discs ++ found,
      Vector(
        Legend.line("mean and 95 % interval", line),
        Legend.box(s"within ${curve.tolerance.text(judge.unit)} of no link", tolerated)
      ) ++ found.map(_ => Legend.line("margin", left))*
    )
