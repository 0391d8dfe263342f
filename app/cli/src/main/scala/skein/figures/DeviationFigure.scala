package skein.figures

import skein.measure.Deviation
import skein.plot.*
import skein.record.ClockKind
import skein.units.Decimals.signed

/** Deviations from the paused flight by scenario, link and loop: discs are means, thick lines reach one
  * standard deviation to either side, thin ones from the least to the most. Live flights have a ring around
  * the disc.
  */
object DeviationFigure:
  val name = "deviation"

  private val gap    = 26.0
  private val height = 200.0

  /** Approximate width of a letter of small text. */
  private val letterWidth = 4.6

  def apply(deviations: Vector[Deviation]): Option[Drawing] = Option.when(deviations.nonEmpty):
    def place(one: Deviation) = (one.scenario, one.link)
    val links                 = deviations.map(place).distinct
    val placed                = links.zipWithIndex.flatMap: (link, index) =>
      deviations.filter(place(_) == link).map((_, index))
    val slot  = (8 + deviations.map(_.name.length).max * letterWidth).max(62)
    val width = placed.size * slot + links.size * gap
    val panel = Panel(
      PlotAxis.exactly("", 0, width, 1),
      PlotAxis.around(
        "deviation from the paused truth, %",
        100 * deviations.map(_.share.least).min.min(0),
        100 * deviations.map(_.share.most).max.max(0)
      ),
      left = 52,
      top = 14,
      width,
      height
    )
    val marks = placed.zipWithIndex.flatMap:
      case ((deviation, link), index) =>
        mark(panel, deviation, panel.left + (index + 0.5) * slot + (link + 0.5) * gap)
    val names = links.zipWithIndex.flatMap: (link, index) =>
      val members = placed.zipWithIndex.collect { case ((_, `index`), place) => place }
      val middle  = panel.left + (members.sum.toDouble / members.size + 0.5) * slot + (index + 0.5) * gap
      Vector(FlightTheme.link(link._2), link._1).zipWithIndex.filter(_._1.nonEmpty).map: (text, line) =>
        Mark.Text(Point(middle, panel.bottom + 38 + 14 * line), text, anchor = Anchor.Middle)
    val truth   = panel.level(0, Stroke(FlightTheme.of("paused"), 1.2))
    val drawing = Drawing(
      width + 70,
      height + 66 + (if deviations.exists(_.scenario.nonEmpty) then 14 else 0),
      panel.rules(panel.left, panel.right) ++ panel.yAxis ++ (truth +: (marks ++ names))
    )
    if deviations.exists(isLive) then Drawing.stacked(drawing, legend(panel.left)) else drawing

  private def legend(left: Double): Drawing =
    def item(label: String, live: Boolean) =
      Legend.Item(label, 14, at => disc(at.moved(7, 0), Theme.labelColour, live))
    Legend(left, item("live", live = true), item("in virtual time", live = false))

  private def isLive(deviation: Deviation): Boolean = deviation.clock != ClockKind.Virtual.label

  private def disc(centre: Point, colour: Colour, live: Boolean): Vector[Mark] =
    Mark.Disc(centre, 4, Some(Stroke(FlightTheme.halo, 0.8)), Some(colour)) +:
      Option.when(live)(Mark.Disc(centre, 6.5, Some(Stroke(colour, 1.2)))).toVector

  private def mark(panel: Panel, deviation: Deviation, x: Double): Vector[Mark] =
    val colour                                        = FlightTheme.of(deviation.loop)
    val share                                         = deviation.share
    def line(from: Double, to: Double, width: Double) =
      Mark.line(Point(x, panel.atY(100 * from)), Point(x, panel.atY(100 * to)), Stroke(colour, width))
    val percent = s"${(100 * share.mean).signed(1)} %"
    val centre  = Point(x, panel.atY(100 * share.mean))
    Vector(
      line(share.least, share.most, 1),
      line(share.mean - share.sampleSd, share.mean + share.sampleSd, 3.2),
      Mark.Text(Point(x, panel.bottom + 13), deviation.name, Theme.smallSize, anchor = Anchor.Middle),
      Mark.Text(Point(x, panel.bottom + 24), percent, Theme.smallSize, Theme.tickColour, Anchor.Middle)
    ) ++ disc(centre, colour, isLive(deviation))
