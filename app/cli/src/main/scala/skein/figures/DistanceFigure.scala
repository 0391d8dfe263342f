package skein.figures

import skein.measure.{Distribution, FlightSet, FlightSummary}
import skein.plot.*
import skein.units.Decimals.brief

/** Distance between pursuer and evader over time, one panel per link, with the paused flight in each. At the
  * right of a panel stand mean and range of the last 10 s of each flight, above its name: ours as a coloured
  * disc, the paper's as a black diamond. The axis fits our curves; where a range of the paper extends beyond
  * it, an arrow states how far, or where the mean is.
  */
object DistanceFigure:
  private val plotWidth  = 830.0
  private val plotHeight = 220.0
  private val slotWidth  = 26.0

  /** Approximate width of a letter of small text. */
  private val letterWidth = 4.9

  def apply(set: FlightSet): Option[Drawing] =
    val linksOfNote = set.links.filter(link => set.over(link).exists(flight => !set.truth.contains(flight)))
    val links       = if linksOfNote.nonEmpty then linksOfNote else set.links
    val strokes     = FlightTheme.curves(set.flights)
    val panels      = links
      .map(link => (set.truth.toVector ++ set.over(link)).distinct.filter(_.distance.nonEmpty))
      .zip(links)
      .collect { case (flights, link) if flights.nonEmpty => panel(link, flights, strokes) }
    Option.when(panels.nonEmpty)(Drawing.stacked(panels*))

  private def panel(link: String, flights: Vector[FlightSummary], strokes: Map[String, Stroke]): Drawing =
    val curves    = flights.flatMap(summary => summary.distance.map(summary -> _))
    val published =
      flights.flatMap(summary => summary.published.flatMap(_.distance))
    val highest = curves.flatMap(_._2.points.map(_._2)).max
    val panel   = Panel(
      PlotAxis.around("time, s", 0, curves.map(_._2.points.last._1).max, 6),
      PlotAxis.around("distance, m", 0, highest),
      left = 52,
      top = 34,
      plotWidth,
      plotHeight
    )
    val lines =
      curves.map((summary, curve) => panel.curve(curve.points, strokes(summary.name)))
    val stripsLeft  = panel.right + 17
    val stripsWidth = curves.size.max(5) * slotWidth
    val strips      = curves.zipWithIndex.flatMap:
      case ((summary, curve), index) =>
        val x = stripsLeft + (index + 0.5) * slotWidth
        curve.lastTenSeconds.toVector.flatMap(strip(panel, x, summary, _))
    val named = curves.zipWithIndex.collect:
      case ((summary, curve), index) if curve.lastTenSeconds.isDefined =>
        Mark.Text(
          Point(stripsLeft + (index + 0.5) * slotWidth + 3, panel.bottom + 8),
          summary.name,
          Theme.smallSize,
          anchor = Anchor.End,
          upwards = true
        )
    val below = named.map(_.content.length).maxOption.fold(0.0)(_ * letterWidth + 12)
    val above = Point(stripsLeft, panel.top - 10)
    val signs = Seq(curves.flatMap(_._2.lastTenSeconds) -> "ours ●", published -> "paper ◆")
      .collect { case (values, sign) if values.nonEmpty => sign }
    val heading =
      Option.when(signs.nonEmpty)(Mark.Text(above, signs.mkString("last 10 s: ", ", ", ""), Theme.tickSize))
    val drawn = Drawing(
      stripsLeft + stripsWidth + 50,
      plotHeight + 84.0.max(panel.top + below),
      panel.axes ++ heading ++ panel.rules(stripsLeft, stripsLeft + stripsWidth) ++ lines ++ strips ++ named
    )
    Legend.titled(panel, FlightTheme.link(link), drawn, FlightTheme.names(flights, strokes)*)

  private def strip(panel: Panel, x: Double, summary: FlightSummary, last: Distribution): Vector[Mark] =
    val colour = FlightTheme.of(summary.flight.loop)
    val ours   = Vector(
      Mark.line(Point(x - 5, panel.atY(last.least)), Point(x - 5, panel.atY(last.most)), Stroke(colour, 2)),
      Mark.Disc(Point(x - 5, panel.atY(last.mean)), 3.6, Some(Stroke(FlightTheme.halo, 0.8)), Some(colour))
    )
    val paper = summary.published.flatMap(_.distance).toVector.flatMap: published =>
      val isMeanSeen = published.mean <= panel.y.to
      val top        = Point(x + 5, panel.atY(published.most.min(panel.y.to)))
      val low = Point(x + 5, panel.atY(published.least.min(panel.y.to - (panel.y.to - panel.y.from) * 0.06)))
      val diamond =
        Option.when(isMeanSeen)(FlightTheme.diamond(Point(x + 5, panel.atY(published.mean)))).toVector
      val goesOn =
        if published.most <= panel.y.to then Vector.empty
        else
          val head = Vector(top.moved(-3, 5), top, top.moved(3, 5))
          val text = if isMeanSeen then s"to ${published.most.brief} m" else s"mean ${published.mean.brief} m"
          Vector(
            Mark.Path(head, Some(Stroke(FlightTheme.published, 1.2))),
            // Upright, so that labels of neighbouring columns do not overlap.
            Mark.Text(top.moved(11, 2), text, Theme.smallSize, anchor = Anchor.End, upwards = true)
          )
      (Mark.line(low, top, Stroke(FlightTheme.published, 1.2)) +: goesOn) ++ diamond
    ours ++ paper
