package skein.benchmark

import skein.plot.*
import skein.units.Decimals.signed

/** The deviation of each entry from the paused loop: a panel for each world, with a row for each entry and a
  * column for each task and link.
  */
object BenchmarkFigure:
  private val cellWidth  = 44.0
  private val cellHeight = 20.0
  private val left       = 190.0
  private val gap        = 8.0
  private val linksSize  = 96.0

  /** Deviations from this one on have one colour, %. */
  private val MostOff = 50.0
  private val colours = ColourScale.aroundZero(0, MostOff)
  private val broken  = Stroke(Colour(0x111111), 1.6)

  def apply(rows: Vector[BenchmarkRow]): Drawing =
    val tasks                   = rows.map(_.cell.task.name).distinct
    val links                   = rows.map(_.cell.link).distinct
    val entries                 = rows.map(_.entry.name).distinct
    def x(task: Int, link: Int) = left + task * (links.size * cellWidth + gap) + link * cellWidth
    val right                   = x(tasks.size - 1, links.size)

    def panel(world: String): Drawing =
      val top    = 22.0
      val bottom = top + entries.size * cellHeight
      val names  = entries.zipWithIndex.map: (entry, row) =>
        val at = Point(left - gap, top + (row + 0.7) * cellHeight)
        Mark.Text(at, entry, Theme.tickSize, anchor = Anchor.End)
      val cells = rows.filter(_.cell.world.name == world).flatMap: row =>
        val at = Point(
          x(tasks.indexOf(row.cell.task.name), links.indexOf(row.cell.link)),
          top + entries.indexOf(row.entry.name) * cellHeight
        )
        cell(row).map(_.moved(at.x, at.y))
      Drawing(
        right + 20,
        bottom + 10,
        Mark.Text(Point(left, 15), world, Theme.labelSize, Theme.titleColour, bold = true) +: (names ++ cells)
      )

    val heads =
      for (task, number) <- tasks.zipWithIndex
      yield Mark.Text(Point(x(number, 0), 46), task, Theme.labelSize, Theme.titleColour, bold = true)
    val columns =
      for
        (_, task)      <- tasks.zipWithIndex
        (link, number) <- links.zipWithIndex
        at = Point(x(task, number) + cellWidth / 2 + 4, 50 + linksSize)
      yield Mark.Text(at, link, Theme.tickSize, upwards = true)
    val legend = Legend(
      left,
      Vector(5.0, 20, MostOff).map(off =>
        Legend.box(if off == MostOff then "50 % and more" else s"${off.toInt} %", colours.of(off))
      ) :+ Legend.line("breaks limits that the truth keeps", broken)*
    )
    val title = Mark.Text(
      Point(left, 20),
      s"How far off the paused truth, %, benchmark ${BenchmarkSet.Version}",
      Theme.titleSize,
      Theme.titleColour,
      bold = true
    )
    Drawing.stacked(
      Drawing(right + 20, 56 + linksSize, title +: (heads ++ columns)) +:
        rows.map(_.cell.world.name).distinct.map(panel) :+ legend*
    )

  /** The marks of one table row, with their top left corner at the origin. */
  private def cell(row: BenchmarkRow): Vector[Mark] =
    val (right, bottom) = (cellWidth - 2, cellHeight - 2)
    val middle          = Point(right / 2, bottom - 5)
    val shown           = row.meanOff.toVector.flatMap: off =>
      val per    = 100 * off
      val colour = if per.abs > 0.7 * MostOff then Colour(0xffffff) else Theme.titleColour
      Vector(
        Mark.box(0, 0, right, bottom, colours.of(per.abs)),
        Mark.Text(middle, per.signed(if per.abs < 10 then 1 else 0), Theme.tickSize, colour, Anchor.Middle)
      )
    val isBroken = row.violations > 0
    shown ++ Option.when(isBroken)(Mark.outline(0, 0, right, bottom, broken))
