package skein.figures

import skein.loop.LoopKind
import skein.measure.FlightSummary
import skein.plot.{Colour, Legend, Point, Mark, Stroke}

/** One colour per loop in every picture: Okabe and Ito's palette, told apart by colour-blind readers too. */
object FlightTheme:
  private def of(loop: LoopKind): Colour = loop match
    case LoopKind.Paused     => Colour(0x404040)
    case LoopKind.Sequential => Colour(0xd55e00)
    case LoopKind.Futures    => Colour(0x0072b2)
    case LoopKind.Stream     => Colour(0x009e73)
    case LoopKind.Predictive => Colour(0xaa4499)
    case LoopKind.Plan       => Colour(0xe69f00)

  /** Of the loop that a recording names; one that is not known is ochre. */
  def of(loop: String): Colour = LoopKind.parse(loop).fold(_ => Colour(0xb58900), of)

  /** What was published stands in black beside our colours. */
  val published: Colour = Colour(0x111111)
  val halo: Colour      = Colour(0xffffff)
  val evader: Colour    = Colour(0x8c8c8c)

  /** A flight's curve: dashed where it was not flown with the paper's policies. */
  def of(flight: FlightSummary, width: Double = 1.4): Stroke =
    val solid = line(of(flight.flight.loop), width)
    if flight.policy.isEmpty then solid else solid.copy(dash = Vector(6, 3))

  /** Of flights' curves, each name once. */
  def names(flights: Vector[FlightSummary]): Vector[Legend.Item] =
    flights.distinctBy(_.name).map(flight => Legend.line(flight.name, of(flight, 2.2)))

  def line(colour: Colour, width: Double = 1.4): Stroke = Stroke(colour, width)

  /** How a link is named in titles. */
  def link(name: String): String = if name == "none" then "no network" else s"$name link"

  /** The mark of a published value. */
  def diamond(centre: Point, radius: Double = 4): Mark =
    val corners = Vector((0.0, -radius), (radius, 0.0), (0.0, radius), (-radius, 0.0)).map(centre.moved(_, _))
    Mark.Path(corners, Some(Stroke(halo, 0.8)), Some(published), closed = true)
