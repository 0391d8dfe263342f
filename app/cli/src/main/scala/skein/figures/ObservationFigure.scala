package skein.figures

import skein.measure.{FlightSet, FlightSummary, Published, RoleSummary, TimingObservation}
import skein.plot.*

/** The paper's bar charts: means of the four observations, grouped by link and loop, a full bar for the
  * evader's decisions and a pale one for the pursuer's, or by a team's roles. Black diamonds are the paper's
  * means, if there are any; in the charts of ages, outlines are the true ages.
  */
object ObservationFigure:
  private val barWidth = 20.0
  private val loopGap  = 14.0
  private val linkGap  = 32.0
  private val left     = 46.0
  private val palePart = 0.45

  def apply(set: FlightSet): Option[Drawing] =
    val flights = set.flights.filter(_.roles.nonEmpty)
    Option.when(flights.nonEmpty):
      val observed = FlightSummary.observations(flights)
      val longest  = observed.map(_.title.length).max * Theme.titleLetter
      val panels   = Drawing.grid(observed.map(panel(_, flights, longest)), columns = 2)
      Drawing.stacked(panels, Legend.rows(left, panels.width - left, legend(flights)*))

  /** A panel for bars of milliseconds.
    *
    * @param highest the highest bar, ms
    */
  private[figures] def bars(width: Double, highest: Double): Panel = Panel(
    PlotAxis.exactly("", 0, width, 1),
    PlotAxis.around("ms", 0, highest * 1.06),
    left,
    top = 34,
    width,
    height = 150
  )

  /** @param least least width of the bars, so that no title is cut */
  private def panel(observation: TimingObservation, flights: Vector[FlightSummary], least: Double): Drawing =
    val shown   = flights.flatMap(summary => summary.roles.map(role => bar(observation, summary, role)))
    val highest = shown.flatMap(bar => bar.mean ++ bar.published ++ bar.trueAge).maxOption.getOrElse(1.0)
    val lefts   = placed(flights)
    val width   = (lefts.last + widthOf(flights.last) + loopGap).max(least)
    val panel   = bars(width, highest)
    val groups  = flights.zip(lefts).flatMap: (summary, left) =>
      val drawn = summary.roles.zipWithIndex.flatMap: (role, index) =>
        draw(panel, bar(observation, summary, role), panel.left + left + index * barWidth, pale = index > 0)
      val middle = panel.left + left + widthOf(summary) / 2
      val at     = Point(middle, panel.bottom + 13)
      drawn :+ Mark.Text(at, summary.flight.loop, Theme.smallSize, anchor = Anchor.Middle)
    val links = flights.zip(lefts).groupBy(_._1.flight.link).toVector.flatMap: (link, members) =>
      val from = panel.left + members.map(_._2).min
      val to   = panel.left + members.map((summary, left) => left + widthOf(summary)).max
      val at   = Point((from + to) / 2, panel.bottom + 30)
      Vector(
        Mark.line(Point(from, panel.bottom + 18), Point(to, panel.bottom + 18), Theme.axisLine),
        Mark.Text(at, FlightTheme.link(link), Theme.tickSize, anchor = Anchor.Middle)
      )
    val title = panel.title(observation.title.capitalize)
    val rules = panel.rules(panel.left, panel.right)
    Drawing(width + 76, panel.height + 78, (title +: rules) ++ panel.yAxis ++ groups ++ links)

  private final case class Bar(
      colour: Colour,
      mean: Option[Double],
      published: Option[Double],
      trueAge: Option[Double]
  )

  private def bar(observation: TimingObservation, summary: FlightSummary, role: RoleSummary): Bar =
    val published = summary.published
    val trueAge   = observation match
      case TimingObservation.OwnAge      => role.ownTrueAgeMs
      case TimingObservation.OpponentAge => role.opponentTrueAgeMs
      case _                             => None
    Bar(
      FlightTheme.of(summary.flight.loop),
      role.observedMs.get(observation).map(_.mean),
      published.map(flight => Published.ofRole(flight.observedMs(observation), role.role)),
      trueAge.map(_.mean)
    )

  private def draw(panel: Panel, bar: Bar, left: Double, pale: Boolean): Vector[Mark] =
    val right   = left + barWidth - 2
    val middle  = (left + right) / 2
    val outline = bar.trueAge.toVector.map: age =>
      Mark.outline(left, panel.atY(age), right, panel.bottom, trueAgeLine(bar.colour))
    val filled = bar.mean.toVector.flatMap: mean =>
      val colour = if pale then bar.colour.tinted(palePart) else bar.colour
      Vector(Mark.box(left, panel.atY(mean), right, panel.bottom, colour))
    val mark = bar.published.toVector.map(mean => FlightTheme.diamond(Point(middle, panel.atY(mean)), 3.6))
    outline ++ filled ++ mark

  private def widthOf(summary: FlightSummary): Double = summary.roles.size * barWidth

  /** Left edges of the flights' groups of bars, with wider gaps between links. */
  private def placed(flights: Vector[FlightSummary]): Vector[Double] =
    flights
      .sliding(2)
      .collect { case Vector(one, next) => (one, next) }
      .scanLeft(loopGap):
        case (left, (one, next)) =>
          left + widthOf(one).max(44) + (if one.flight.link == next.flight.link then loopGap else linkGap)
      .toVector

  private def legend(flights: Vector[FlightSummary]): Seq[Legend.Item] =
    val grey             = Colour(0x666666)
    def role(place: Int) = flights.flatMap(_.roles.lift(place)).map(_.role).distinct.mkString(", ")
    val full             = Legend.box(s"deciding for the ${role(0)}", grey)
    val pale             =
      Option.when(role(1).nonEmpty)(Legend.box(s"for the ${role(1)}", grey.tinted(palePart)))
    val paper = Option.when(flights.exists(_.published.nonEmpty)):
      Legend.sign("paper")(FlightTheme.diamond(_))
    Seq(full) ++ pale ++ paper ++ Seq(
      Legend.Item(
        "true age, by the simulator's clock",
        12,
        at => Vector(Mark.outline(at.x, at.y - 6, at.x + 12, at.y + 6, trueAgeLine(grey)))
      )
    )

  private def trueAgeLine(colour: Colour): Stroke = Stroke(colour, 0.9, Vector(2.5, 1.8))
