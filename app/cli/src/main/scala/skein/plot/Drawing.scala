package skein.plot

/** A picture: shapes on a canvas, in the order in which they are painted. Lengths are in CSS pixels, 1/96
  * inch, from the top left corner, y downwards. [[Svg]] and [[Png]] render it.
  */
final case class Drawing(width: Double, height: Double, shapes: Vector[Mark])

object Drawing:

  /** Arranges drawings in rows of `columns`; every cell is as large as the largest drawing. */
  def grid(cells: Seq[Drawing], columns: Int): Drawing =
    require(cells.nonEmpty && columns > 0, "a grid needs a cell and a column")
    val width  = cells.map(_.width).max
    val height = cells.map(_.height).max
    val shapes = cells.zipWithIndex.flatMap: (cell, index) =>
      cell.shapes.map(_.moved(index % columns * width, index / columns * height))
    Drawing(width * columns.min(cells.size), height * ((cells.size + columns - 1) / columns), shapes.toVector)

  def stacked(parts: Drawing*): Drawing =
    val tops = parts.scanLeft(0.0)(_ + _.height)
    Drawing(
      parts.map(_.width).max,
      tops.last,
      parts.zip(tops).flatMap((part, top) => part.shapes.map(_.moved(0, top))).toVector
    )

/** A place in a drawing, in its units.
  *
  * @param x distance from the left edge
  * @param y distance from the upper edge
  */
final case class Point(x: Double, y: Double):
  def moved(dx: Double, dy: Double): Point = Point(x + dx, y + dy)

/** A colour.
  *
  * @param rgb 0xRRGGBB
  * @param opacity 0 (invisible) to 1
  */
final case class Colour(rgb: Int, opacity: Double = 1):
  def faded(opacity: Double): Colour = copy(opacity = opacity)

  /** Mixed with white: `share` is the fraction of this colour. */
  def tinted(share: Double): Colour =
    def channel(shift: Int) = math.round(255 + ((rgb >> shift & 0xff) - 255) * share).toInt << shift
    copy(rgb = channel(16) | channel(8) | channel(0))

/** How a line is drawn.
  *
  * @param width the line's width, in the drawing's units
  * @param dash lengths of dash and gap; empty for a solid line
  */
final case class Stroke(colour: Colour, width: Double, dash: Vector[Double] = Vector.empty):

  /** The stroke with the dash pattern of this index; all patterns differ without colours, too. Beyond
    * [[Stroke.Dashes]] a pattern is a dash and three, four or more dots.
    */
  def dashed(number: Int): Stroke =
    def dashAndDots =
      Vector(10.0, 3.0) ++ Vector.fill(number - Stroke.Dashes.size + 3)(Vector(2.0, 3.0)).flatten
    copy(dash = Stroke.Dashes.applyOrElse(number, _ => dashAndDots))

object Stroke:
  /** Dash patterns, the solid line first. */
  val Dashes: Vector[Vector[Double]] = Vector(
    Nil,
    Seq(7, 3),
    Seq(2, 2),
    Seq(8, 2, 2, 2),
    Seq(14, 4),
    Seq(6, 2, 2, 2, 2, 2),
    Seq(2, 5),
    Seq(12, 3, 5, 3)
  ).map(_.map(_.toDouble).toVector)

/** Sizes and colours that all pictures share. */
object Theme:
  val smallSize = 9.0
  val tickSize  = 10.0
  val labelSize = 11.0
  val titleSize = 12.0

  /** Estimated width of a letter of a title, in CSS pixels. */
  val titleLetter = 7.5

  val titleColour: Colour = Colour(0x1a1a1a)
  val labelColour: Colour = Colour(0x333333)
  val tickColour: Colour  = Colour(0x555555)
  val gridLine: Stroke    = Stroke(Colour(0xe9e9e9), 0.8)
  val axisLine: Stroke    = Stroke(Colour(0x888888), 0.9)

/** The part of a text that lies at its point. */
enum Anchor:
  case Start, Middle, End

/** A shape or text of a drawing. */
enum Mark:
  case Path(
      points: Vector[Point],
      stroke: Option[Stroke],
      fill: Option[Colour] = None,
      closed: Boolean = false
  )

  case Disc(centre: Point, radius: Double, stroke: Option[Stroke], fill: Option[Colour] = None)

  /** One line of text.
    *
    * @param at the point on the baseline at the text's anchor
    * @param upwards turned by a quarter, reading upwards
    */
  case Text(
      at: Point,
      content: String,
      size: Double = Theme.labelSize,
      colour: Colour = Theme.labelColour,
      anchor: Anchor = Anchor.Start,
      bold: Boolean = false,
      upwards: Boolean = false
  )

  /** A bitmap, stretched to this size.
    *
    * @param at the bitmap's top left corner
    * @param png the file
    */
  case Raster(at: Point, width: Double, height: Double, png: Array[Byte])

  def moved(dx: Double, dy: Double): Mark = this match
    case raster: Raster => raster.copy(at = raster.at.moved(dx, dy))
    case path: Path     => path.copy(points = path.points.map(_.moved(dx, dy)))
    case disc: Disc     => disc.copy(centre = disc.centre.moved(dx, dy))
    case text: Text     => text.copy(at = text.at.moved(dx, dy))

object Mark:
  def line(from: Point, to: Point, stroke: Stroke): Mark = Path(Vector(from, to), Some(stroke))

  def box(left: Double, top: Double, right: Double, bottom: Double, fill: Colour): Mark =
    Path(rectangle(left, top, right, bottom), stroke = None, Some(fill), closed = true)

  def outline(left: Double, top: Double, right: Double, bottom: Double, stroke: Stroke): Mark =
    Path(rectangle(left, top, right, bottom), Some(stroke), closed = true)

  private def rectangle(left: Double, top: Double, right: Double, bottom: Double): Vector[Point] =
    Vector(Point(left, top), Point(right, top), Point(right, bottom), Point(left, bottom))
