package skein.budget

import skein.plot.*

/** How far the objective is off the truth, by latency and jitter, one panel per period: the contour where it leaves the
  * tolerance, and the marked links.
  */
object BudgetFigure:
  private val width  = 430.0
  private val height = 300.0
  private val mark   = Colour(0x111111)
  private val limit  = Stroke(Colour(0x111111), 1.8)
  private val empty  = Colour(0xf0f0f0)

  /** @param maps
    *   of the same question at several periods
    */
  def apply(maps: Vector[BudgetMap]): Drawing =
    val most  = maps.map(largest).max
    val scale = ColourScale.aroundZero(most)
    val cells = maps.map(panel(_, scale))
    val title = s"${maps.head.policy}: ${maps.head.objective}, per cent off the paused truth"
    val grid  = Drawing.grid(cells, columns = cells.size.min(3))
    val head  = Drawing(
      grid.width,
      62,
      Vector(
        Shape.Text(Point(62, 18), title, Ink.titleSize, Ink.titleColour, bold = true),
        Shape.Text(Point(62, 33), maps.head.vehicles, Ink.tickSize, Ink.labelColour)
      ) ++
        Legend(
          62,
          Legend.line(s"${brief(maps.head.tolerance * 100)} % off the truth", limit),
          Legend.box("no such link: jitter without latency", empty)
        ).shapes.map(_.moved(0, 40))
    )
    Drawing.stacked(head, grid)

  private def panel(map: BudgetMap, scale: ColourScale): Drawing =
    val per    = map.legs.perRoundTrip
    val budget = map.budget
    val heat   = HeatMap(
      budget.meansMs.map(_ / per),
      budget.jittersMs.map(_ / per),
      budget.jittersMs.indices.toVector.map: i =>
        budget.meansMs.indices.toVector.map(j => budget.deviation(i, j).map(_ * 100))
    )
    val panel = Panel(
      Axis.exactly(s"mean latency, ${map.legs.text}, ms", heat.xs.head, heat.xs.last, 8),
      Axis.exactly("jitter p99 − p50, ms", heat.ys.head, heat.ys.last),
      left = 62,
      top = 34,
      width,
      height
    )
    val contours =
      for
        level  <- Vector(-1, 1).map(_ * map.tolerance * 100)
        (a, b) <- heat.contour(level)
      yield Shape.line(panel.at(a._1, a._2), panel.at(b._1, b._2), limit)
    val marks = map.marks.flatMap: link =>
      val (x, y) = (link.roundTrip.mean.toMillis / per, link.roundTrip.jitter.toMillis / per)
      if x > heat.xs.last || y > heat.ys.last then Vector.empty
      else
        val at = panel.at(x, y)
        Vector(
          Shape.Disc(at, 4.5, Some(Stroke(Colour(0xffffff), 1.4)), Some(mark)),
          Shape.Text(at.moved(8, 4), link.name, Ink.labelSize, mark, bold = true)
        )
    Drawing(
      panel.right + 110,
      panel.bottom + 44,
      Vector(
        panel.title(s"${map.loop} every ${brief(map.periodMs)} ms, truth ${brief(budget.truth)} ${map.unit}"),
        Shape.box(panel.left, panel.top, panel.right, panel.bottom, empty)
      ) ++ heat.cells(panel, scale) ++ contours ++ marks ++
        scale.bar(panel.right + 20, panel.top, panel.bottom, "off, %") ++ panel.xAxis ++ panel.yAxis
    )

  /** In per cent, the largest deviation of most cells: a few wild ones shall not make the others pale. */
  private def largest(map: BudgetMap): Double =
    val sizes =
      for
        i   <- map.budget.jittersMs.indices
        j   <- map.budget.meansMs.indices
        off <- map.budget.deviation(i, j)
      yield off.abs * 100
    sizes.sorted.lift((sizes.size * 0.97).toInt).getOrElse(1.0).max(2 * map.tolerance * 100)

  private def brief(value: Double): String = skein.settings.PolicyFile.brief(value)
