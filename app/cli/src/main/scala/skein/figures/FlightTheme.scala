package skein.figures

import skein.loop.LoopKind
import skein.measure.FlightSummary
import skein.plot.{Colour, Legend, Point, Mark, Stroke}

/** One colour per loop in every picture: Okabe and Ito's palette, which colour-blind readers can distinguish,
  * too.
  */
object FlightTheme:
  private def of(loop: LoopKind): Colour = loop match
    case LoopKind.Paused     => Colour(0x404040)
    case LoopKind.Sequential => Colour(0xd55e00)
    case LoopKind.Futures    => Colour(0x0072b2)
    case LoopKind.Stream     => Colour(0x009e73)
    case LoopKind.Predictive => Colour(0xaa4499)
    case LoopKind.Plan       => Colour(0xe69f00)

  /** The colour of a recording's loop; ochre for an unknown one. */
  def of(loop: String): Colour = LoopKind.parse(loop).fold(_ => Colour(0xb58900), of)

  /** The colour of published values, distinct from ours. */
  val published: Colour = Colour(0x111111)
  val halo: Colour      = Colour(0xffffff)
  val evader: Colour    = Colour(0x8c8c8c)

  /** Curves of flights in one picture, by the flights' names: in their loops' colours, each with its own
    * dashes, so that they can be distinguished without colours, too.
    */
  def curves(flights: Vector[FlightSummary]): Map[String, Stroke] =
    flights.distinctBy(_.name).zipWithIndex
      .map((flight, index) => flight.name -> line(of(flight.flight.loop)).dashed(index))
      .toMap

  /** Legend entries of flights' curves, each name once. */
  def names(flights: Vector[FlightSummary], curves: Map[String, Stroke]): Vector[Legend.Item] =
    flights.map(_.name).distinct.map(name => Legend.line(name, curves(name).copy(width = 2.2)))

  def line(colour: Colour, width: Double = 1.4): Stroke = Stroke(colour, width)

  def link(name: String): String = if name == "none" then "no link added" else s"$name link"

  /** The mark of a published value. */
  def diamond(centre: Point, radius: Double = 4): Mark =
    val corners = Vector((0.0, -radius), (radius, 0.0), (0.0, radius), (-radius, 0.0)).map(centre.moved(_, _))
    Mark.Path(corners, Some(Stroke(halo, 0.8)), Some(published), closed = true)
