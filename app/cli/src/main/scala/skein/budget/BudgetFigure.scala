package skein.budget

import skein.plot.*
import skein.search.WholeFlights
import skein.units.Decimals.significant

/** How far the objective is off the truth, by latency and jitter, one panel per period: the contour where it
  * leaves the tolerance, and the marked links.
  */
object BudgetFigure:
  private val width  = 430.0
  private val height = 300.0
  private val mark   = Colour(0x111111)
  private val limit  = Stroke(Colour(0x111111), 1.8)
  private val empty  = Colour(0xf0f0f0)

  /** @param maps of the same question at several periods
    */
  def apply(maps: Vector[BudgetMap]): Drawing =
    val (_, unit) = maps.head.tolerance.shown(maps.head.unit)
    val most      = maps.map(largest).max
    val scale     = ColourScale.aroundZero(most)
    val cells     = maps.map(panel(_, scale))
    val title     =
      s"${maps.head.policy}: ${maps.head.objective}, how far off the paused truth, $unit".stripSuffix(", ")
    val grid = Drawing.grid(cells, columns = cells.size.min(3))
    val head = Drawing(
      grid.width,
      62,
      Vector(
        Mark.Text(Point(62, 18), title, Theme.titleSize, Theme.titleColour, bold = true),
        Mark.Text(Point(62, 33), maps.head.vehicles, Theme.tickSize)
      ) ++
        Legend(
          62,
          Legend.line(s"${maps.head.tolerance.text(maps.head.unit)} off the truth", limit),
          Legend.box("no such link: jitter without latency", empty)
        ).shapes.map(_.moved(0, 40))
    )
    Drawing.stacked(head, grid)

  private def panel(map: BudgetMap, scale: ColourScale): Drawing =
    val per            = map.legs.perRoundTrip
    val (factor, unit) = map.tolerance.shown(map.unit)
    val budget         = map.budget
    val heat           = HeatMap(
      budget.meansMs.map(_ / per),
      budget.jittersMs.map(_ / per),
      budget.jittersMs.indices.toVector.map: i =>
        budget.meansMs.indices.toVector.map(j => budget.deviation(i, j).map(_ * factor))
    )
    val panel = Panel(
      PlotAxis.exactly(s"mean latency, ${map.legs.text}, ms", heat.xs.head, heat.xs.last, 8),
      PlotAxis.exactly("jitter p99 − p50, ms", heat.ys.head, heat.ys.last),
      left = 62,
      top = 34,
      width,
      height
    )
    val contours =
      for
        level  <- Vector(-1, 1).map(_ * map.tolerance.value * factor)
        (a, b) <- heat.contour(level)
      yield Mark.line(panel.at(a._1, a._2), panel.at(b._1, b._2), limit)
    val marks = map.marks.filter(map.isOnMap).flatMap: link =>
      val at = panel.at(link.roundTrip.mean.toMillis / per, link.roundTrip.jitter.toMillis / per)
      Vector(
        Mark.Disc(at, 4.5, Some(Stroke(Colour(0xffffff), 1.4)), Some(mark)),
        Mark.Text(at.moved(8, 4), link.name, colour = mark, bold = true)
      )
    Drawing(
      panel.right + 110,
      panel.bottom + 44,
      Vector(
        panel.title(
          s"${map.loop} every ${map.periodMs.significant(4)} ms, " +
            s"truth ${budget.truth.significant(4)} ${map.unit}".trim
        ),
        Mark.box(panel.left, panel.top, panel.right, panel.bottom, empty)
      ) ++ heat.cells(panel, scale) ++ contours ++ marks ++
        scale.bar(
          panel.right + 20,
          panel.top,
          panel.bottom,
          s"off, $unit".stripSuffix(", ")
        ) ++ panel.xAxis ++ panel.yAxis
    )

  /** The largest deviation of most cells: a few wild ones shall not make the others pale, nor those with a
    * flight that never came to a measure.
    */
  private def largest(map: BudgetMap): Double =
    val (factor, _) = map.tolerance.shown(map.unit)
    val sizes       =
      for
        i   <- map.budget.jittersMs.indices
        j   <- map.budget.meansMs.indices
        off <- map.budget.deviation(i, j)
        if off.abs * map.budget.per < WholeFlights.Never / (2 * map.episodes)
      yield off.abs * factor
    sizes.sorted.lift((sizes.size * 0.97).toInt).getOrElse(1.0).max(2 * map.tolerance.value * factor)
