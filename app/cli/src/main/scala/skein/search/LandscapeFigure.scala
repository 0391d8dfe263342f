package skein.search

import skein.optimise.Direction
import skein.plot.*
import skein.units.Decimals.significant

/** A landscape as a picture: a curve with the spread of the episodes for one parameter, else a map; the found
  * candidate and the defaults are marked. The axis, or the scale of colours, ends after the better nine
  * tenths of the values if the rest would take most of it. A map's legend states the standard error of a
  * cell, since pure noise shows all colours, too.
  */
object LandscapeFigure:
  private val width  = 560.0
  private val height = 340.0
  private val line   = Colour(0x0072b2)
  private val found  = Colour(0xd55e00)
  private val plain  = Colour(0x111111)

  /** @param value the objective with its unit, for the axis or the scale
    * @param direction the direction in which the objective improves
    */
  def apply(landscape: Landscape, title: String, value: String, direction: Direction): Drawing =
    if landscape.y.isEmpty then curve(landscape, title, value, direction)
    else map(landscape, title, value, direction)

  private val MostNamed = 3

  /** Values of the parameters that are not drawn, if there are any: a few by name. */
  private[search] def fixed(landscape: Landscape): Option[String] =
    val drawn  = landscape.x +: landscape.y.toVector
    val others = landscape.space.axes.indices.toVector.filterNot(drawn.contains)
    Option.when(others.nonEmpty):
      if others.sizeIs > MostNamed then s"${others.size} others at the best"
      else
        others
          .map(axis => AxisTitle.of(landscape.space.axes(axis).name).at(landscape.best(axis)))
          .mkString("at the best: ", ", ", "")

  /** Draws a curve; NaN values, as of vehicles that fly away, are left out. */
  private def curve(landscape: Landscape, title: String, value: String, direction: Direction): Drawing =
    val axis   = landscape.space.axes(landscape.x)
    val points = landscape.xs.zip(landscape.cells.head).filter((_, tally) =>
      (tally.mean + tally.sd).isFinite && (tally.mean - tally.sd).isFinite
    )
    // Values of vehicles that fly away must not make the rest flat: the scale of a map's colours is used
    // here, too.
    val fitting     = LandscapeScale.of(points.map(_._2.mean), direction)
    val near        = points.filter((_, tally) => tally.mean >= fitting.from && tally.mean <= fitting.to)
    val (low, high) = ends(near.map((_, tally) => (mean = tally.mean, sd = tally.sd)))
    val panel       = Panel(
      PlotAxis.exactly(AxisTitle.of(axis.name).text, axis.least, axis.most),
      PlotAxis.around(value, low, high),
      left = 62,
      top = 52,
      width,
      height
    )
    def edge(x: Double, y: Double) = panel.at(x, y.max(panel.y.from).min(panel.y.to))
    val band                       = points.map((x, tally) => edge(x, tally.mean + tally.sd)) ++
      points.reverse.map((x, tally) => edge(x, tally.mean - tally.sd))
    Legend.between(
      panel,
      title,
      (panel.axes :+ Mark.Path(band, None, Some(line.faded(0.25)), closed = true)) ++
        panel.cut(points.map((x, tally) => (x, tally.mean)), Stroke(line, 2)) ++
        Vector(panel.upright(landscape.best.head, foundLine), panel.upright(axis.default, defaultLine)),
      Legend.line("mean", Stroke(line, 2)),
      Legend.box("± one standard deviation of the episodes", line.tinted(0.25)),
      Legend.line(s"found, ${landscape.best.head.significant(4)}", foundLine),
      Legend.line(s"default, ${axis.default.significant(4)}", defaultLine)
    )

  /** The line of the found candidate: broad and pale below the default's thin line, so that both are visible
    * where they coincide.
    */
  private val foundLine   = Stroke(found.tinted(0.6), 5)
  private val defaultLine = Stroke(plain, 1.4, Vector(5, 3))

  /** Ends of an axis that contain the means and most of the standard deviations. */
  private[search] def ends(near: Vector[(mean: Double, sd: Double)]): (Double, Double) =
    if near.isEmpty then (0.0, 1.0)
    else
      val (least, most) = (near.map(_.mean).min, near.map(_.mean).max)
      val sds           = near.map(_.sd).sorted
      val margin        = sds(((sds.size - 1) * 0.9).toInt)
      (least - margin, most + margin)

  private def map(landscape: Landscape, title: String, value: String, direction: Direction): Drawing =
    val (xAxis, yAxis) = (landscape.space.axes(landscape.x), landscape.space.axes(landscape.y.get))
    val subtitle       = fixed(landscape)
    val panel          = Panel(
      PlotAxis.exactly(AxisTitle.of(xAxis.name).text, xAxis.least, xAxis.most),
      PlotAxis.exactly(AxisTitle.of(yAxis.name).text, yAxis.least, yAxis.most),
      left = 62,
      top = if subtitle.isEmpty then 52 else 70,
      height * 1.2,
      height
    )
    val heat   = HeatMap(landscape.xs, landscape.ys, landscape.cells.map(_.map(tally => Some(tally.mean))))
    val scale  = LandscapeScale.of(landscape.cells.flatten.map(_.mean), direction)
    val best   = ring(panel.at(landscape.best(landscape.x), landscape.best(landscape.y.get)))
    val paper  = disc(panel.at(xAxis.default, yAxis.default))
    val off    = s"standard error of a cell ${landscape.standardError.significant(2)}"
    val legend = Legend(
      panel.left,
      Legend.Item("found", 16, at => ring(at.moved(8, 0))),
      Legend.sign("default" + (if landscape.space.dimension > 2 then ", the others as found" else ""))(disc),
      Legend.Item(off, 0, _ => Vector.empty)
    )
    Drawing(
      panel.right + 120,
      panel.bottom + 44,
      (Mark.Text(Point(panel.left, 20), title, Theme.titleSize, Theme.titleColour, bold = true) +:
        subtitle.map(text => Mark.Text(Point(panel.left, 36), text)).toVector) ++
        legend.shapes.map(_.moved(0, panel.top - 30)) ++
        heat.cells(panel, scale) ++
        scale.bar(panel.right + 24, panel.top, panel.bottom, value) ++
        panel.xAxis ++ panel.yAxis ++ (best :+ paper)
    )

  /** A ring large enough to be visible around the default's mark. */
  private def ring(centre: Point): Vector[Mark] = Vector(
    Mark.Disc(centre, 7.5, Some(Stroke(Colour(0xffffff), 4.2))),
    Mark.Disc(centre, 7.5, Some(Stroke(found, 2.2)))
  )

  private def disc(centre: Point): Mark =
    Mark.Disc(centre, 3.6, Some(Stroke(Colour(0xffffff), 1.2)), Some(plain))
