package skein.plot

/** A rectangle of a drawing with an axis below and one at its left; converts values to points. */
final case class Panel(x: PlotAxis, y: PlotAxis, left: Double, top: Double, width: Double, height: Double):
  import Theme.*

  def right: Double  = left + width
  def bottom: Double = top + height

  def at(xValue: Double, yValue: Double): Point = Point(atX(xValue), atY(yValue))
  def atX(value: Double): Double                = left + x.share(value) * width
  def atY(value: Double): Double                = bottom - y.share(value) * height

  /** A line through values; at most one point per tenth of a pixel is kept. */
  def curve(values: Iterable[(Double, Double)], stroke: Stroke): Mark =
    val points = values.iterator.map(at(_, _)).toVector
    val kept   = points.foldLeft(Vector.empty[Point]): (kept, point) =>
      if kept.lastOption.exists(last => math.hypot(point.x - last.x, point.y - last.y) < 0.1) then kept
      else kept :+ point
    Mark.Path(kept, Some(stroke))

  /** A line through values, cut where it leaves the vertical axis. */
  def cut(values: Vector[(Double, Double)], stroke: Stroke): Vector[Mark] =
    def isIn(value: (Double, Double))                        = value._2 >= y.from && value._2 <= y.to
    def edge(one: (Double, Double), other: (Double, Double)) =
      val to    = if one._2 > y.to || other._2 > y.to then y.to else y.from
      val share = (to - one._2) / (other._2 - one._2)
      (one._1 + (other._1 - one._1) * share, to)
    val seen = values.zip(values.drop(1)).flatMap: (one, other) =>
      (isIn(one), isIn(other)) match
        case (true, true)  => Some((one, other))
        case (true, false) => Some((one, edge(one, other)))
        case (false, true) => Some((edge(one, other), other))
        case _             => None
    val pieces = seen.foldLeft(Vector.empty[Vector[(Double, Double)]]):
      case (done :+ piece, (from, to)) if piece.last == from => done :+ (piece :+ to)
      case (done, (from, to))                                => done :+ Vector(from, to)
    pieces.map(curve(_, stroke))

  /** A horizontal line from the left edge to the right one. */
  def level(value: Double, stroke: Stroke): Mark =
    Mark.line(Point(left, atY(value)), Point(right, atY(value)), stroke)

  /** A vertical line from the upper edge to the lower one. */
  def upright(value: Double, stroke: Stroke): Mark =
    Mark.line(Point(atX(value), top), Point(atX(value), bottom), stroke)

  /** Grid, lines, numbers and names of both axes; to be painted below the values. */
  def axes: Vector[Mark] = grid ++ xAxis ++ yAxis

  private def grid: Vector[Mark] =
    x.ticks.map(upright(_, gridLine)) ++ rules(left, right)

  /** Horizontal lines at the ticks of the vertical axis. */
  def rules(from: Double, to: Double): Vector[Mark] =
    y.ticks.map(tick => Mark.line(Point(from, atY(tick)), Point(to, atY(tick)), gridLine))

  def xAxis: Vector[Mark] =
    x.ticks.map: tick =>
      Mark.Text(Point(atX(tick), bottom + 14), x.text(tick), tickSize, tickColour, Anchor.Middle)
    ++ Vector(
      Mark.line(Point(left, bottom), Point(right, bottom), axisLine),
      Mark.Text(Point(left + width / 2, bottom + 30), x.label, anchor = Anchor.Middle)
    )

  def yAxis: Vector[Mark] =
    y.ticks.map: tick =>
      Mark.Text(Point(left - 6, atY(tick) + 3.5), y.text(tick), tickSize, tickColour, Anchor.End)
    ++ Vector(
      Mark.line(Point(left, top), Point(left, bottom), axisLine),
      Mark.Text(Point(left - 36, top + height / 2), y.label, anchor = Anchor.Middle, upwards = true)
    )

  def title(text: String): Mark = title(text, titleSize)

  /** A title that flights' names may make long: smaller if it would be wider than the panel. */
  def fittedTitle(text: String): Mark =
    title(text, (titleSize * width / (text.length * titleLetter).max(1)).min(titleSize).max(smallSize))

  private def title(text: String, size: Double): Mark =
    Mark.Text(Point(left, top - 10), text, size, titleColour, bold = true)
