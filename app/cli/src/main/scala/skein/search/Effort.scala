package skein.search

import skein.settings.VehicleChoice

/** Default numbers of episodes: fewer where one costs more.
  *
  * @param freshEpisodes for evaluating a search's winner
  * @param landscapeEpisodes for each point of the objective's landscape
  * @param onMap points on each side of a landscape of two parameters
  * @param cellEpisodes for each cell of a budget's map
  * @param onCurve points of a landscape of one parameter
  */
final case class Effort(
    freshEpisodes: Int,
    landscapeEpisodes: Int,
    onMap: Int,
    cellEpisodes: Int,
    onCurve: Int = Landscape.OnCurve
):
  /** This effort with at most `fresh` episodes for a point of the landscape. */
  def within(fresh: Int): Effort = copy(landscapeEpisodes = landscapeEpisodes.min(fresh))

object Effort:
  /** Episodes that one core simulates in about half a second. */
  def blockEpisodes(byLanes: Boolean, vehicle: VehicleChoice): Int =
    (byLanes, vehicle.fliesInSteps) match
      case (true, false)  => 32768
      case (true, true)   => 2048
      case (false, false) => 512
      case (false, true)  => 16

  private val Cheap  = Effort(4096, 256, Landscape.OnMap, 1000)
  private val Seeing = Cheap.copy(landscapeEpisodes = 64)
  private val Dear   = Effort(512, 16, 21, 30)
  private val Dearer = Effort(64, 4, 13, 4)

  /** The effort of duels.
    *
    * @param together whether candidates with shared episodes use SIMD
    * @param alone whether worlds with delays of their own use SIMD
    * @param sees whether a player observes the other through a sensor: simulating images costs several times
    *   as much as everything else, and more with images of a world's own
    */
  def of(together: Boolean, alone: Boolean, vehicle: VehicleChoice, sees: Boolean): Effort =
    def level(byLanes: Boolean, isDear: Boolean) = (byLanes, isDear) match
      case (true, false) => Cheap
      case (true, true)  => Dear
      case (false, _)    => if vehicle.fliesInSteps then Dearer else Dear
    val candidates = level(together, vehicle.fliesInSteps) match
      case Cheap if sees => Seeing
      case other         => other
    val worlds = level(alone, vehicle.fliesInSteps || sees)
    Effort(worlds.freshEpisodes, candidates.landscapeEpisodes, candidates.onMap, worlds.cellEpisodes)

  /** Fresh episodes of a team: few enough for the scalar engine to simulate in seconds. */
  val TeamsFresh = 256

  /** The effort of flights in virtual time, which run at some a second. */
  val OfFlights: Effort = Effort(16, 1, 5, 2, onCurve = 9)

  def ofTeam(byLanes: Boolean): Effort =
    if byLanes then Effort(TeamsFresh, 16, 21, 300) else Effort(TeamsFresh, 2, 7, 10)

  /** The effort of a team whose measures are of whole flights, with the scalar engine. */
  val OfScalarFlights: Effort = ofTeam(byLanes = false).copy(cellEpisodes = 4)
