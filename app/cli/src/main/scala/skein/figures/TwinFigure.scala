package skein.figures

import skein.measure.{Compared, Distribution, FlightSet, Twin}
import skein.plot.*
import skein.units.Decimals.{fixed, signed}

/** Cumulative distributions of the decisions' observations in live flights and in their virtual twins, one
  * row of panels per live flight, for evader and pursuer.
  */
object TwinFigure:
  val name = "twins"

  private val panelWidth  = 208.0
  private val panelHeight = 110.0
  private val points      = 200
  private val virtualLine = Stroke(FlightTheme.published, 1, Vector(4, 2.5))

  def apply(set: FlightSet): Option[Drawing] =
    val lines = set.twins.filter(_.compared.nonEmpty).map(line)
    Option.when(lines.nonEmpty)(Drawing.stacked((lines :+ legend(set))*))

  private def line(twin: Twin): Drawing =
    val flight = twin.live.flight
    val came   = twin.live.headlineOf.zip(twin.converged).zip(twin.difference).map:
      case ((measure, (live, virtual)), difference) =>
        def told(value: Double) = s"${value.fixed(2)} ${measure.unit}".trim
        s": ${measure.name} ${told(live)} live, ${told(virtual)} virtual (${(100 * difference).signed(1)} %)"
    val name   = s"${twin.live.name}, ${FlightTheme.link(flight.link)}${came.getOrElse("")}"
    val title  = Mark.Text(Point(46, 16), name, Theme.titleSize, Theme.titleColour, bold = true)
    val panels = Drawing.grid(twin.compared.map(panel(flight.loop, _)), columns = twin.compared.size)
    Drawing.stacked(Drawing(panels.width, 22, Vector(title)), panels)

  private def panel(loop: String, compared: Compared): Drawing =
    val most  = compared.live.quantile(0.995).max(compared.virtual.quantile(0.995))
    val panel = Panel(
      PlotAxis.around(s"${compared.quantity}, ms", 0, most, 4),
      PlotAxis.exactly("share of decisions", 0, 1, 4),
      left = 46,
      top = 20,
      panelWidth,
      panelHeight
    )
    val name  = s"${compared.role}: KS ${compared.distance.fixed(2)}"
    val title = Mark.Text(Point(panel.left, panel.top - 6), name)
    Drawing(
      panelWidth + 62,
      panelHeight + 62,
      (title +: panel.axes) ++ Vector(
        curve(panel, compared.live, FlightTheme.line(FlightTheme.of(loop), 2.4)),
        curve(panel, compared.virtual, virtualLine)
      )
    )

  /** A distribution's curve from the panel's left edge to its right one; the last half per cent may lie
    * beyond.
    */
  private def curve(panel: Panel, samples: Distribution, stroke: Stroke): Mark =
    val rising = Vector
      .tabulate(points + 1)(index => index.toDouble / points)
      .map(share => (samples.quantile(share), share))
      .takeWhile(_._1 <= panel.x.to)
    val reached = rising.lastOption.fold(0.0)(_._2)
    panel.curve(Vector((0.0, 0.0), (samples.least, 0.0)) ++ rising :+ (panel.x.to, reached), stroke)

  private def legend(set: FlightSet): Drawing =
    val loops = set.twins.map(_.live.flight.loop).distinct
    val live  = loops.map(loop => Legend.line(s"$loop, live", FlightTheme.line(FlightTheme.of(loop), 2.4)))
    Legend(46, (live :+ Legend.line("virtual", virtualLine))*)
