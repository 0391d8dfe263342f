package skein.search

import skein.lanes.Engine
import skein.settings.VehicleChoice

/** Default numbers of episodes: fewer where an episode costs more.
  *
  * @param freshEpisodes number of episodes for evaluating a search's winner
  * @param landscapeEpisodes number of episodes for each point of the objective's landscape
  * @param onMap number of points on each side of a landscape of two parameters
  * @param cellEpisodes number of episodes for each cell of a budget's map
  * @param onCurve number of points of a landscape of one parameter
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
  /** Number of episodes that one core simulates in about half a second. */
  def blockEpisodes(isFast: Boolean, vehicle: VehicleChoice): Int =
    (isFast, vehicle.fliesInSteps) match
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
    * @param together the engine of candidates that share their episodes
    * @param alone the engine of worlds with delays of their own
    * @param sees whether a vehicle observes the other by a sensor: an episode with images costs several times
    *   one without, and more if each world has its own images
    */
  def of(together: Engine, alone: Engine, vehicle: VehicleChoice, sees: Boolean): Effort =
    def level(engine: Engine, isDear: Boolean) = (engine.isFast, isDear) match
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

  /** Default numbers of episodes for flights in virtual time: only a few can be simulated per second. */
  val OfFlights: Effort = Effort(16, 1, 5, 2, onCurve = 9)

  def ofTeam(engine: Engine): Effort =
    if engine.fliesByLanes then Effort(TeamsFresh, 16, 21, 300) else ScalarTeams

  private val ScalarTeams = Effort(TeamsFresh, 2, 7, 10)

  /** The effort of a team with measures of whole flights, on the scalar engine. */
  val OfScalarFlights: Effort = ScalarTeams.copy(cellEpisodes = 4)
