package skein.figures

import skein.plot.{Colour, Stroke}
import skein.scenario.Scenario

/** Line styles of a scenario's vehicles: one for each [[Scenario.shade]] of each role, all different. */
object VehicleTheme:
  /** Colours by vehicle's role: Okabe and Ito's, as for the loops, and two of Tol's. */
  private val colours   = Vector(0x0072b2, 0xd55e00, 0x009e73, 0xaa4499, 0xe69f00, 0x56b4e9).map(Colour(_))
  private val lead      = Colour(0x404040)
  private val lightness = Vector(1.0, 0.65, 0.4)

  /** Number of distinct line styles. */
  private[figures] val Most: Int = colours.size * Stroke.Dashes.size * lightness.size

  /** Line styles by vehicle. The first vehicle that is alone in its role is grey; the others take colours in
    * turn, then with dashes, then lighter.
    *
    * @param width the lines' width, in the drawing's units
    */
  def of(scenario: Scenario, width: Double): Vector[Stroke] =
    val agents = scenario.agents
    val kinds  = agents.indices.map(vehicle => (agents(vehicle).role, scenario.shade(vehicle)))
    val alone  = agents.map(_.role).find(role => agents.sizeIs > 1 && agents.count(_.role == role) == 1)
    val styles = kinds.distinct.filterNot((role, _) => alone.contains(role)).zipWithIndex.toMap
    kinds.toVector.map(kind => styles.get(kind).fold(Stroke(lead, width))(numbered(_, width)))

  private def numbered(index: Int, width: Double): Stroke =
    val dash = index / colours.size
    Stroke(
      colours(index % colours.size).tinted(lightness(dash / Stroke.Dashes.size % lightness.size)),
      width
    ).dashed(dash % Stroke.Dashes.size)
