package skein.plot

import skein.units.Decimals.significant

/** Colours for values between two ends; values beyond get the end's colour.
  *
  * @param beyond which ends stand for values beyond them, too; the bar says so
  */
final case class ColourScale(
    from: Double,
    to: Double,
    stops: Vector[Int],
    beyond: Set[ColourScale.End] = Set.empty
):
  import ColourScale.End

  def of(value: Double): Colour =
    val place = if to > from then ((value - from) / (to - from)).max(0).min(1) else 0.5
    val at    = place * (stops.size - 1)
    val below = at.toInt.min(stops.size - 2)
    ColourScale.mixed(stops(below), stops(below + 1), at - below)

  /** A bar that shows the scale, with ticks at its right and the label above. */
  def bar(left: Double, top: Double, bottom: Double, label: String): Vector[Mark] =
    val slices = 64
    val width  = 14.0
    val height = bottom - top
    val boxes  = Vector.tabulate(slices): i =>
      Mark.box(
        left,
        bottom - height * (i + 1) / slices,
        left + width,
        (bottom - height * i / slices + 0.5).min(bottom),
        of(from + (to - from) * (i + 0.5) / slices)
      )
    val axis = PlotAxis.exactly(label, from, if to > from then to else from + 1)
    def text(value: Double, content: String) =
      val at = Point(left + width + 5, bottom - height * axis.share(value) + 3.5)
      Mark.Text(at, content, Theme.tickSize, Theme.tickColour)
    val ends = Vector(End.Low -> (axis.from, "≤"), End.High -> (axis.to, "≥")).collect:
      case (end, (value, sign)) if beyond(end) => (value, text(value, s"$sign ${value.significant(3)}"))
    // Ticks that would touch the text of an end are left out.
    val ticks = axis.ticks
      .filter(tick => ends.forall((value, _) => height * (axis.share(tick) - axis.share(value)).abs >= 12))
      .map(tick => text(tick, axis.text(tick)))
    boxes ++ ticks ++ ends.map(_._2) :+ Mark.Text(Point(left, top - 8), label, Theme.tickSize)

  /** An error bar for beside [[bar]], around its middle, no longer than it; none where all has one colour.
    *
    * @param off how far values are off to either side
    */
  def errorBar(x: Double, top: Double, bottom: Double, off: Double, stroke: Stroke): Vector[Mark] =
    if !(to > from) then Vector.empty
    else
      ColourScale.errorBar(
        Point(x, (top + bottom) / 2),
        (bottom - top) * (off / (to - from)).min(0.5),
        stroke
      )

object ColourScale:
  /** An upright one.
    *
    * @param off half its length
    */
  def errorBar(middle: Point, off: Double, stroke: Stroke): Vector[Mark] =
    def cap(at: Point) = Mark.line(at.moved(-3, 0), at.moved(3, 0), stroke)
    val (low, high)    = (middle.moved(0, off), middle.moved(0, -off))
    Vector(Mark.line(low, high, stroke), cap(low), cap(high))

  enum End:
    case Low, High

  /** Matplotlib's viridis by nine of its colours: even in lightness, also for colour-blind readers. */
  def viridis(from: Double, to: Double): ColourScale = ColourScale(
    from,
    to,
    Vector(0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c, 0x28ae80, 0x5ec962, 0xaddc30, 0xfde725)
  )

  /** White in the middle, blue below and red above (ColorBrewer's RdBu, turned round). */
  def aroundZero(most: Double): ColourScale = ColourScale(
    -most,
    most,
    Vector(0x2166ac, 0x67a9cf, 0xd1e5f0, 0xffffff, 0xfddbc7, 0xef8a62, 0xb2182b)
  )

  private def mixed(a: Int, b: Int, share: Double): Colour =
    def channel(shift: Int) =
      math.round((a >> shift & 0xff) * (1 - share) + (b >> shift & 0xff) * share).toInt << shift
    Colour(channel(16) | channel(8) | channel(0))
