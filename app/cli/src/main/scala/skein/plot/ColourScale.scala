package skein.plot

import skein.units.Decimals.significant

/** Colours for values between two ends; values beyond an end have its colour.
  *
  * @param beyond the ends whose colour also stands for values beyond them; the bar marks these
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

object ColourScale:
  enum End:
    case Low, High

  /** Matplotlib's viridis, interpolated from nine of its colours: even in lightness, also for colour-blind
    * readers.
    */
  def viridis(from: Double, to: Double): ColourScale = ColourScale(
    from,
    to,
    Vector(0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c, 0x28ae80, 0x5ec962, 0xaddc30, 0xfde725)
  )

  /** White at zero, blue below and red above (ColorBrewer's RdBu, reversed), symmetric around zero; only one
    * side if all values have one sign.
    *
    * @param least the minimum value, at most 0
    * @param most the greatest value, at least 0
    */
  def aroundZero(least: Double, most: Double): ColourScale =
    val reach = most.max(-least)
    // A sliver of the other side would be too thin to be seen.
    if -least < 0.05 * reach then ColourScale(0, reach, White +: Reds)
    else if most < 0.05 * reach then ColourScale(-reach, 0, Blues :+ White)
    else ColourScale(-reach, reach, (Blues :+ White) ++ Reds)

  private val White = 0xffffff
  private val Blues = Vector(0x2166ac, 0x67a9cf, 0xd1e5f0)
  private val Reds  = Vector(0xfddbc7, 0xef8a62, 0xb2182b)

  private def mixed(a: Int, b: Int, share: Double): Colour =
    def channel(shift: Int) =
      math.round((a >> shift & 0xff) * (1 - share) + (b >> shift & 0xff) * share).toInt << shift
    Colour(channel(16) | channel(8) | channel(0))
