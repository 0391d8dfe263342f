package skein.lanes

import skein.forward.{LoopTiming, RolloutAgent, TabledDelays}
import skein.lanes.loop.{LaneAgents, LoopKernel, LoopLanes}
import skein.lanes.policy.{OpponentLanes, TeamLanes}
import skein.lanes.score.Scoreboard
import skein.lanes.timetable.{TimetableAgents, TimetableKernel, Timetables}
import skein.units.eachBelow

/** Teams of one form in many worlds, with their scores. Mutable. */
private[lanes] abstract class LaneTeams(form: TeamForm):
  protected val scores: Scoreboard = Scoreboard(form.scores, form.altitudesDownM)
  private val held                 = Array.ofDim[PreparedTeam](TimetableKernel.WORLDS)

  protected def members: Array[? <: TeamMember]

  /** Sets a world's candidate, which must be of this form. */
  final def take(world: Int, team: PreparedTeam): Unit =
    val before = held(world)
    if team ne before then
      held(world) = team
      eachBelow(members.length): self =>
        val numbers = team.numbers(self)
        // Candidates often have the identical object as their opponent.
        if before == null || (numbers ne before.numbers(self)) then members(self).take(world, numbers)
      if form.hasParameters then scores.take(world, team.ofScores)

  /** Simulates one episode in each world.
    *
    * @param worldOf indices of these worlds among all
    * @param filled number of worlds that count, from the first
    */
  def fly(worlds: TeamWorlds, worldOf: Array[Int], filled: Int): Unit

  /** Copies the results of the first worlds.
    *
    * @param worldOf indices of these worlds among all
    */
  final def tell(worldOf: Array[Int], filled: Int, into: TeamOutcomes): Unit =
    var score = 0
    for (effort, number) <- form.efforts.zipWithIndex do
      val told = into.values(number)
      effort match
        case Some(vehicle) =>
          val rad = members(vehicle).effortRad
          for lane <- 0 until filled do told(worldOf(lane)) = rad(lane)
        case None =>
          for lane <- 0 until filled do told(worldOf(lane)) = scores.value(score, lane)
          score += 1

private[lanes] object LaneTeams:
  /** The vehicles of worlds that all have one episode.
    *
    * @param agents the vehicles of one of these teams, which are alike
    */
  def inEpisode(form: TeamForm, agents: Vector[RolloutAgent]): Array[? <: TimetableAgents & TeamMember] =
    form.policies match
      case team: TeamLanes    => TeamAgents.of(agents, form.vehicles, TeamViews(team))
      case two: OpponentLanes =>
        Opponents.inEpisode(agents, form.vehicles, Opponents.policiesOf(two), Opponents.eyesOf(two))

/** Teams whose worlds all have one episode.
  *
  * @param first one of these teams, whose vehicles are alike
  */
private[lanes] final class EpisodeTeams(
    form: TeamForm,
    first: TeamCandidate,
    episodes: Episodes,
    timetables: Timetables
) extends LaneTeams(form):
  private val flown  = LaneTeams.inEpisode(form, first.engagement.agents)
  private val kernel = TimetableKernel(flown.map(identity[TimetableAgents]), scores)

  protected def members: Array[? <: TeamMember] = flown

  def fly(worlds: TeamWorlds, worldOf: Array[Int], filled: Int): Unit =
    val (link, key) = (worlds.link(worldOf(0)), worlds.key(worldOf(0)))
    val timetable   = timetables.getOrMake(episodes.nameOf(link, key, form)):
      episodes.timetable(link, key, form)
    if form.isSensed then
      val seeds = worldOf.map(worlds.key(_).toLong)
      for self <- flown.indices do flown(self).vehicles.seed(seeds, self)
    kernel.fly(timetable, filled)

/** Teams whose worlds have separate delays.
  *
  * @param first one of these teams, whose vehicles are alike
  * @param maxDelayS the longest one-way delay of any link
  */
private[lanes] final class LoopTeams(
    form: TeamForm,
    first: TeamCandidate,
    timing: LoopTiming,
    maxDelayS: Double
) extends LaneTeams(form):
  private val loop = LoopLanes(
    timing,
    form.vehicles.map(_.predictor),
    form.durationS,
    maxDelayS,
    form.sees,
    noise = form.vehicles.map(_.sensors)
  )
  private val (flown, eye) = form.policies match
    case team: TeamLanes =>
      (LoopTeamAgents.of(first.engagement.agents, loop, form.vehicles, TeamViews(team)), None)
    case two: OpponentLanes =>
      Opponents.inLoop(first.engagement.agents, loop, form.vehicles, Opponents.policiesOf(two), two.cameras)
  private val kernel = LoopKernel(loop, flown.map(identity[LaneAgents]), scores)

  protected def members: Array[? <: TeamMember] = flown

  def fly(worlds: TeamWorlds, worldOf: Array[Int], filled: Int): Unit =
    val (keys, links) = (worldOf.map(worlds.key), worldOf.map(worlds.link(_).asInstanceOf[TabledDelays]))
    eye.foreach(_.start(keys, links))
    kernel.fly(keys, links)
