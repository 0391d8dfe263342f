package skein.search

import skein.optimise.Direction
import skein.plot.*
import skein.units.Decimals.significant

/** A landscape as a picture: a curve with the spread of the episodes for one parameter, else a map; the found
  * candidate marked, and the defaults. Beside a map's colours stands the standard error of a cell, since pure
  * noise has all the colours too.
  */
object LandscapeFigure:
  private val width  = 560.0
  private val height = 340.0
  private val line   = Colour(0x0072b2)
  private val found  = Colour(0xd55e00)
  private val plain  = Colour(0x111111)
  private val error  = Stroke(plain, 1.2)

  /** @param value what the objective is, with its unit, for the axis or the scale
    * @param direction where the objective is to go
    */
  def apply(landscape: Landscape, title: String, value: String, direction: Direction): Drawing =
    if landscape.y.isEmpty then curve(landscape, title, value) else map(landscape, title, value, direction)

  private val MostNamed = 3

  /** At which values the parameters are that are not drawn, if there are any: a few by their names. */
  private[search] def fixed(landscape: Landscape): Option[String] =
    val drawn  = landscape.x +: landscape.y.toVector
    val others = landscape.space.axes.indices.toVector.filterNot(drawn.contains)
    Option.when(others.nonEmpty):
      if others.sizeIs > MostNamed then s"${others.size} others at the best"
      else
        others
          .map(axis => AxisTitle.of(landscape.space.axes(axis).name).at(landscape.best(axis)))
          .mkString("at the best: ", ", ", "")

  /** Of values that are no number, as of vehicles that fly off without end, nothing is drawn. */
  private def curve(landscape: Landscape, title: String, value: String): Drawing =
    val axis   = landscape.space.axes(landscape.x)
    val points = landscape.xs.zip(landscape.cells.head).filter((_, tally) =>
      (tally.mean + tally.sd).isFinite && (tally.mean - tally.sd).isFinite
    )
    val low   = points.map((_, tally) => tally.mean - tally.sd).minOption.getOrElse(0.0)
    val high  = points.map((_, tally) => tally.mean + tally.sd).maxOption.getOrElse(1.0)
    val panel = Panel(
      PlotAxis.exactly(AxisTitle.of(axis.name).text, axis.least, axis.most),
      PlotAxis.around(value, low, high),
      left = 62,
      top = 52,
      width,
      height
    )
    val band = points.map((x, tally) => panel.at(x, tally.mean + tally.sd)) ++
      points.reverse.map((x, tally) => panel.at(x, tally.mean - tally.sd))
    def marked(x: Double, colour: Colour) =
      Mark.line(
        Point(panel.atX(x), panel.top),
        Point(panel.atX(x), panel.bottom),
        Stroke(colour, 1.6, Vector(5, 3))
      )
    val legend = Legend(
      panel.left,
      Legend.line("mean", Stroke(line, 2)),
      Legend.box("± one standard deviation of the episodes", line.tinted(0.25)),
      Legend.line(s"found, ${landscape.best.head.significant(4)}", Stroke(found, 1.6, Vector(5, 3))),
      Legend.line(s"default, ${axis.default.significant(4)}", Stroke(plain, 1.6, Vector(5, 3)))
    )
    Drawing(
      panel.right + 40,
      panel.bottom + 44,
      (panel.title(title).moved(0, -22) +: legend.shapes.map(_.moved(0, 22))) ++ panel.axes ++ Vector(
        Mark.Path(band, None, Some(line.faded(0.25)), closed = true),
        panel.curve(points.map((x, tally) => (x, tally.mean)), Stroke(line, 2)),
        marked(axis.default, plain),
        marked(landscape.best.head, found)
      )
    )

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
    val best   = disc(panel.at(landscape.best(landscape.x), landscape.best(landscape.y.get)), found)
    val paper  = disc(panel.at(xAxis.default, yAxis.default), plain)
    val off    = scale.errorBar(panel.right + 16, panel.top, panel.bottom, landscape.standardError, error)
    val legend = Legend(
      panel.left,
      Vector(
        named("found", found),
        named("default" + (if landscape.space.dimension > 2 then ", the others as found" else ""), plain)
      ) ++ Option.when(off.nonEmpty)(
        Legend.Item("± standard error", 6, at => ColourScale.errorBar(at.moved(3, 0), 6, error))
      )*
    )
    Drawing(
      panel.right + 120,
      panel.bottom + 44,
      (Mark.Text(Point(panel.left, 20), title, Theme.titleSize, Theme.titleColour, bold = true) +:
        subtitle.map(text => Mark.Text(Point(panel.left, 36), text)).toVector) ++
        legend.shapes.map(_.moved(0, panel.top - 30)) ++
        heat.cells(panel, scale) ++
        scale.bar(panel.right + 24, panel.top, panel.bottom, value) ++
        off ++
        panel.xAxis ++ panel.yAxis ++ Vector(paper, best)
    )

  private def disc(centre: Point, colour: Colour): Mark =
    Mark.Disc(centre, 5, Some(Stroke(Colour(0xffffff), 1.5)), Some(colour))

  private def named(label: String, colour: Colour): Legend.Item =
    Legend.Item(label, 10, at => Vector(disc(at.moved(5, 0), colour)))
