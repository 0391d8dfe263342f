package skein.budget

import skein.optimise.Objective
import skein.plot.*
import skein.units.Decimals.significant

/** The objective's deviation from the paused loop by latency and jitter, one panel per period, with the
  * contour at the tolerance, and the marked links.
  */
object BudgetFigure:
  private val width  = 430.0
  private val height = 300.0
  private val mark   = Colour(0x111111)
  private val limit  = Stroke(Colour(0x111111), 1.8)
  private val empty  = Colour(0xf0f0f0)

  /** @param maps the maps of one question at several periods */
  def apply(maps: Vector[BudgetMap]): Drawing =
    val task      = maps.head.task
    val (_, unit) = maps.head.tolerance.shown(task.unit)
    val scale     = scaleOf(maps)
    val cells     = maps.map(panel(_, scale))
    val title     = s"${task.label}: ${task.formula}, how far off the paused truth, $unit".stripSuffix(", ")
    val grid      = Drawing.grid(cells, columns = cells.size.min(3))
    val head      = Drawing(
      grid.width,
      62,
      Vector(
        Mark.Text(Point(62, 18), title, Theme.titleSize, Theme.titleColour, bold = true),
        Mark.Text(Point(62, 33), task.vehicles, Theme.tickSize)
      ) ++
        Legend(62, legend(maps)*).shapes.map(_.moved(0, 40))
    )
    Drawing.stacked(head, grid)

  /** Legend of everything drawn in at least one of the maps. */
  private[budget] def legend(maps: Vector[BudgetMap]): Vector[Legend.Item] =
    val isPassed = maps.exists(contoursOf(_).nonEmpty)
    val hasGaps  = maps.exists(heatOf(_).values.exists(_.exists(_.isEmpty)))
    Option.when(isPassed)(Legend.line(
      s"${maps.head.tolerance.text(maps.head.task.unit)} off the truth",
      limit
    )).toVector ++
      Option.when(hasGaps)(Legend.box("no such link: jitter without latency", empty))

  private def heatOf(map: BudgetMap): HeatMap =
    val per         = map.legs.perRoundTrip
    val (factor, _) = map.tolerance.shown(map.task.unit)
    HeatMap(
      map.budget.meansMs.map(_ / per),
      map.budget.jittersMs.map(_ / per),
      map.budget.jittersMs.indices.toVector.map: i =>
        map.budget.meansMs.indices.toVector.map(j => map.budget.deviation(i, j).map(_ * factor))
    )

  private def contoursOf(map: BudgetMap) =
    val (factor, _) = map.tolerance.shown(map.task.unit)
    Vector(-1, 1).map(_ * map.tolerance.value * factor).flatMap(heatOf(map).contour)

  private def panel(map: BudgetMap, scale: ColourScale): Drawing =
    val per       = map.legs.perRoundTrip
    val (_, unit) = map.tolerance.shown(map.task.unit)
    val budget    = map.budget
    val heat      = heatOf(map)
    val panel     = Panel(
      PlotAxis.exactly(s"mean latency, ${map.legs.text}, ms", heat.xs.head, heat.xs.last, 8),
      PlotAxis.exactly("jitter p99 − p50, ms", heat.ys.head, heat.ys.last),
      left = 62,
      top = 34,
      width,
      height
    )
    val contours = contoursOf(map).map((a, b) => Mark.line(panel.at(a._1, a._2), panel.at(b._1, b._2), limit))
    val marks    = map.marks.filter(map.isOnMap).flatMap: link =>
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
          s"${map.task.loop} every ${map.task.periodMs.significant(4)} ms, " +
            s"truth ${budget.truth.significant(4)} ${map.task.unit}".trim
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

  /** A scale for the deviations of most cells: neither a few outliers nor cells with a flight that never
    * reached a measure make the others pale.
    */
  private[budget] def scaleOf(maps: Vector[BudgetMap]): ColourScale =
    val offs =
      for
        map <- maps
        (factor, _) = map.tolerance.shown(map.task.unit)
        i   <- map.budget.jittersMs.indices
        j   <- map.budget.meansMs.indices
        off <- map.budget.deviation(i, j)
        if off.abs * map.budget.per < Objective.Never / (2 * map.episodes)
      yield off * factor
    val leastReach = maps.map(map => 2 * map.tolerance.value * map.tolerance.shown(map.task.unit)._1).max
    val sizes      = offs.map(_.abs).sorted
    val reach      = sizes.lift((sizes.size * 0.97).toInt).getOrElse(1.0).max(leastReach)
    ColourScale.aroundZero(
      offs.minOption.getOrElse(0.0).min(0).max(-reach),
      if offs.forall(_ <= 0) && offs.nonEmpty then 0 else reach
    )
