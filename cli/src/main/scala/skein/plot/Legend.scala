package skein.plot

/** One line that says what marks stand for. */
object Legend:
  private val gap         = 18.0
  private val letterWidth = 6.3
  private val middle      = 9.0
  private val height      = 24.0

  /** @param width of the mark
    * @param mark its shapes, when its left end's middle is at the point
    */
  final case class Item(label: String, width: Double, mark: Point => Vector[Mark])

  /** Dashed lines are as long as it takes to tell them apart. */
  def line(label: String, stroke: Stroke): Item =
    val long = if stroke.dash.isEmpty then 20.0 else 30.0
    Item(label, long, at => Vector(Mark.line(at, at.moved(long, 0), stroke)))

  def box(label: String, fill: Colour): Item =
    Item(label, 12, at => Vector(Mark.box(at.x, at.y - 6, at.x + 12, at.y + 6, fill)))

  /** Items from left to right; texts may be a little narrower or wider than the room they get. */
  def apply(left: Double, items: Item*): Drawing =
    val starts =
      items.scanLeft(left)((start, item) => start + item.width + 6 + item.label.length * letterWidth + gap)
    val shapes = items.zip(starts).flatMap: (item, start) =>
      item.mark(Point(start, middle)) :+
        Mark.Text(Point(start + item.width + 6, middle + 4), item.label)
    Drawing(starts.last - gap / 2, height, shapes.toVector)

  /** The same above a panel, up to its right edge. */
  def above(panel: Panel, items: Item*): Vector[Mark] =
    val legend = Legend(0, items*)
    legend.shapes.map(_.moved(panel.right - legend.width, panel.top - 23))
