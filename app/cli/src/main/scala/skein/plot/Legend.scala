package skein.plot

/** One line that explains the marks of a drawing. */
object Legend:
  private val gap         = 18.0
  private val letterWidth = 6.3
  private val middle      = 9.0
  private val height      = 24.0

  /** @param width the mark's width
    * @param mark the mark's shapes, given the middle of its left end
    */
  final case class Item(label: String, width: Double, mark: Point => Vector[Mark])

  /** An item for a line; dashed lines are long enough to be distinguished. */
  def line(label: String, stroke: Stroke): Item =
    val long = if stroke.dash.isEmpty then 20.0 else stroke.dash.sum.max(30)
    Item(label, long, at => Vector(Mark.line(at, at.moved(long, 0), stroke)))

  def box(label: String, fill: Colour): Item =
    Item(label, 12, at => Vector(Mark.box(at.x, at.y - 6, at.x + 12, at.y + 6, fill)))

  /** An item for a sign of one mark, given its middle. */
  def sign(label: String)(mark: Point => Mark): Item = Item(label, 8, at => Vector(mark(at.moved(4, 0))))

  /** Items from left to right; texts may be slightly narrower or wider than their estimated width. */
  def apply(left: Double, items: Item*): Drawing =
    val starts = items.scanLeft(left)(_ + room(_))
    val shapes = items.zip(starts).flatMap: (item, start) =>
      item.mark(Point(start, middle)) :+
        Mark.Text(Point(start + item.width + 6, middle + 4), item.label)
    Drawing(starts.last - gap / 2, height, shapes.toVector)

  private def room(item: Item) = item.width + 6 + item.label.length * letterWidth + gap

  /** A panel's drawing with a title above it and the legend to the right of the title, up to the panel's
    * right edge; a longer legend is set in rows below.
    */
  def titled(panel: Panel, title: String, drawn: Drawing, items: Item*): Drawing =
    val shapes = panel.title(title) +: drawn.shapes
    val legend = Legend(0, items*)
    if title.length * Theme.titleLetter + gap + legend.width <= panel.width then
      val beside = legend.shapes.map(_.moved(panel.right - legend.width, panel.top - 23))
      drawn.copy(shapes = shapes ++ beside)
    else Drawing.stacked(drawn.copy(shapes = shapes), rows(panel.left, panel.width, items*))

  /** The picture of a panel: its title, a line with the legend, and the panel with these shapes. */
  def between(panel: Panel, title: String, shapes: Vector[Mark], items: Item*): Drawing =
    val legend = Legend(panel.left, items*).shapes.map(_.moved(0, 22))
    Drawing(
      panel.right + 40,
      panel.bottom + 44,
      (panel.title(title).moved(0, -22) +: legend) ++ shapes
    )

  /** Items in rows no longer than `width`, unless one item is. */
  def rows(left: Double, width: Double, items: Item*): Drawing =
    val filled = items.foldLeft(Vector.empty[Vector[Item]]):
      case (before :+ row, item) if (row :+ item).map(room).sum <= width => before :+ (row :+ item)
      case (before, item)                                                => before :+ Vector(item)
    Drawing.stacked(filled.map(row => Legend(left, row*))*)
