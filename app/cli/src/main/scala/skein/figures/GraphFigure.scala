package skein.figures

import skein.loop.{GraphLayout, LoopGraph, Spot}
import skein.plot.{Anchor, Colour, Drawing, Point, Mark, Stroke}

/** A loop's graph: parts by their names in the code, edges between them, and feedback edges below. */
object GraphFigure:
  private val High      = 26.0
  private val ColumnGap = 30.0
  private val RowGap    = 14.0
  private val Margin    = 10.0
  private val TurnGap   = 22.0
  private val Letter    = 11.0

  private val edges = Stroke(Colour(0x98a2b3), 1.3)
  private val turns = Stroke(Colour(0xb8860b), 1.3)
  private val boxes = Stroke(Colour(0x475467), 1.2)
  private val ink   = Colour(0x1d2430)

  private final case class Box(left: Double, top: Double, width: Double):
    def middle: Double = left + width / 2
    def right: Double  = left + width
    def bottom: Double = top + High
    def centre: Double = top + High / 2

  /** @param graph a graph with at least one part */
  def apply(graph: LoopGraph): Drawing =
    val spots  = GraphLayout.of(graph)
    val placed = boxesOf(spots)
    val turned = graph.edges.filter(edge => spots(edge.to).column <= spots(edge.from).column)
    val right  = placed.values.map(_.right).max + Margin
    val bottom = placed.values.map(_.bottom).max + Margin
    val leads  =
      graph.edges.filterNot(turned.contains).flatMap(edge => led(placed(edge.from), placed(edge.to)))
    val backs = turned.zipWithIndex.flatMap((edge, at) =>
      back(placed(edge.from), placed(edge.to), bottom + at * TurnGap)
    )
    val parts = graph.stages.flatMap(name => part(name, placed(name)))
    Drawing(right, bottom + turned.size * TurnGap, leads ++ backs ++ parts)

  /** Boxes of the parts; a column is as wide as its longest name. */
  private def boxesOf(spots: Map[String, Spot]): Map[String, Box] =
    val widths = spots.groupMapReduce(_._2.column)((name, _) => name.length * Letter * 0.56 + 16)(_ max _)
    val lefts  = (0 to widths.keys.max).scanLeft(Margin)((left, column) =>
      left + widths.getOrElse(column, 0.0) + ColumnGap
    )
    spots.map((name, spot) =>
      name -> Box(lefts(spot.column), Margin + spot.row * (High + RowGap), widths(spot.column))
    )

  private def part(name: String, box: Box) = Vector(
    Mark.box(box.left, box.top, box.right, box.bottom, Colour(0xffffff)),
    Mark.outline(box.left, box.top, box.right, box.bottom, boxes),
    Mark.Text(Point(box.middle, box.centre + 4), name, Letter, ink, Anchor.Middle)
  )

  /** An edge, drawn behind the boxes that it passes. */
  private def led(from: Box, to: Box) =
    val (start, end) = (Point(from.right, from.centre), Point(to.left, to.centre))
    val bend         = ColumnGap / 2
    val knees        =
      if start.y == end.y then Vector.empty
      else Vector(Point(end.x - bend * 1.6, start.y), Point(end.x - bend * 0.8, end.y))
    Vector(
      Mark.Path(start +: knees :+ end.moved(-6, 0), Some(edges)),
      tip(end, Vector((-7, -4), (-7, 4)), edges.colour)
    )

  private def back(from: Box, to: Box, below: Double) =
    val end = Point(to.middle, to.bottom)
    val way =
      Vector(
        Point(from.middle, from.bottom),
        Point(from.middle, below),
        Point(to.middle, below),
        end.moved(0, 6)
      )
    Vector(Mark.Path(way, Some(turns)), tip(end, Vector((-4, 7), (4, 7)), turns.colour))

  private def tip(at: Point, corners: Vector[(Int, Int)], colour: Colour) =
    Mark.Path(at +: corners.map((x, y) => at.moved(x, y)), None, Some(colour), closed = true)
