package skein.lanes

import java.util.IdentityHashMap
import scala.collection.mutable
import skein.forward.{Delays, LoopTiming, SpatialResponse, TabledDelays, VelocityResponse}
import skein.lanes.loop.{BySlowest, LaneAgents, LoopKernel, LoopLanes}
import skein.lanes.policy.TeamLanes
import skein.lanes.score.{ScoreLanes, Scoreboard}
import skein.lanes.timetable.{Timetable, TimetableAgents, TimetableKernel, Timetables}
import skein.simd.{LaneFunction, LaneMath}
import skein.units.Expect

/** Simulates many candidates of a team under one loop's timing, on all cores. Candidates whose policies and
  * quantities are formulas run on SIMD: worlds that share episodes by [[TimetableKernel]], all of an episode
  * by one [[Timetable]], which is computed once; others by [[LoopKernel]]. Quadrotors and MuJoCo bodies of
  * other teams are stepped side by side under the scalar loops ([[SteppedRollouts]]). All else runs on the
  * scalar reference ([[skein.forward.Rollout]]), which the engine's text states. The engine of a world
  * depends on its candidate, its link and `shareEpisodes` alone, so results do not depend on threads, on a
  * call's other worlds or on their order. One call at a time.
  *
  * @param accelerator simulates the candidates of [[Worlds.episodesOfEach]] that are formulas, if it supports
  *   the loop and the vehicles
  * @param isReference uses the scalar reference alone, to compare others with it
  */
final class TeamBatch(
    timing: LoopTiming,
    model: VelocityResponse,
    threads: Int = Runtime.getRuntime.availableProcessors,
    accelerator: Option[Accelerator] = None,
    isReference: Boolean = false
):
  require(threads > 0, s"threads must be positive, got $threads")

  private val timetables = Timetables()
  private val workers    = Vector.fill(threads)(Worker())

  private val accelerated: Option[Either[String, AcceleratedTeams]] =
    accelerator.map(_.teams(timing, model, threads, timetable))

  private def timetable(link: Delays, key: Int, form: TeamForm): Timetable =
    Timetable.of(form.team.count, form.durationS, timing, link, key, form.vehicles, tellsMore = form.asksMore)

  /** The engine for such a team.
    *
    * @param shareEpisodes see [[TeamWorlds.shareEpisodes]]; on a GPU, only worlds with
    *   [[Worlds.episodesOfEach]] run
    * @param links of the worlds
    */
  def engine(candidate: TeamCandidate, shareEpisodes: Boolean, links: Seq[Delays]): Engine =
    val together = shares(shareEpisodes)
    val lanes    = lanesOf(candidate)
    val worlds   = if together then "candidates of an episode" else "worlds"
    val isPlain  = lanes.exists(_.team.isPlain)
    Engine.of(
      lanes.map(_ => s"${LaneMath.LANES} $worlds at a time"),
      lanes.fold(_ => Nil, form => links.map(refusal(form, together, _))),
      steppedOf(candidate),
      if isPlain then Accelerator.engine(accelerator, accelerated, together)
      else
        accelerated.map(_ =>
          Left("the GPU flies teams without memory that look at the newest readings alone")
        )
      ,
      LaneFunction.COUNT
    )

  private def steppedOf(candidate: TeamCandidate) =
    SteppedRollouts
      .engine(model, candidate.engagement.agents)
      .filterNot(_ =>
        isReference || candidate.engagement.hasCars || model.isSpatial && candidate.engagement.climbs.isDefined
      )

  /** Whether worlds share episodes. A world that waits for its controller has no delays: all worlds share
    * their episode.
    */
  private def shares(asked: Boolean): Boolean = asked || timing.isInstanceOf[LoopTiming.Paused]

  private def refusal(form: TeamForm, share: Boolean, link: Delays): Option[String] =
    if share then None else LoopSupport.refusal(timing, form.team.count, link, form.vehicles)

  private def lanesOf(candidate: TeamCandidate): Either[String, TeamForm] =
    val engagement = candidate.engagement
    val inSpace    = model.isInstanceOf[SpatialResponse]
    for
      _        <- LaneSupport.present
      _        <- Expect.that(!isReference)("the reference was asked for")
      _        <- Expect.that(!engagement.hasCars)("it has cars")
      vehicles <- LaneDynamics.under(timing, model, engagement.agents)
      team     <- TeamLanes
        .of(
          engagement.agents.map(_.policy),
          engagement.assignment,
          timing.isInstanceOf[LoopTiming.Predictive],
          inSpace
        )
        .left
        .map(refused => s"a policy is no formula: ${refused.getMessage}")
      _ <- team.leaves(engagement.agents).filterNot(_ => inSpace).toLeft(())
      _ <- Expect.that(!team.looksUp || !model.regardsYaw):
        "a policy asks how high vehicles are, and the quadrotor's height is not told side by side"
      _ <- Expect.that(
        !team.turns || !model.regardsYaw
      )("a policy may turn its vehicle, and this one keeps its yaw")
      scores <- ScoreLanes
        .of(candidate.judged, engagement.agents.size)
        .left
        .map(refused => s"a quantity is no formula: ${refused.getMessage}")
    yield TeamForm(
      team,
      scores,
      engagement.durationS,
      if inSpace then Vector.empty else engagement.agents.map(_.altitudeDownM)
    )(vehicles)

  /** Simulates all worlds, unless it is cancelled.
    *
    * @param onProgress called with the number of worlds done, after each batch, by one thread at a time
    * @param isCancelled polled before each batch and in between, from any thread; running batches finish, or
    *   are abandoned where vehicles are stepped side by side
    * @throws InterruptedException if the caller is interrupted; running batches have finished then
    */
  def fly(
      worlds: TeamWorlds,
      onProgress: Int => Unit = _ => (),
      isCancelled: () => Boolean = () => false
  ): TeamOutcomes =
    val known                              = IdentityHashMap[TeamCandidate, PreparedTeam]()
    def prepare(number: Int): PreparedTeam =
      known.computeIfAbsent(
        worlds.candidate(number),
        each => PreparedTeam(each, lanesOf(each).toOption, steppedOf(each).isDefined)
      )
    val judged   = if worlds.size == 0 then 0 else worlds.candidate(0).judged.size
    val outcomes = TeamOutcomes(Vector.fill(judged)(Array.ofDim[Float](worlds.size)))
    val together = shares(worlds.shareEpisodes)
    val came     = Accelerated.first(accelerated, worlds, together):
      _.fly(worlds, prepare, outcomes, onProgress, isCancelled)
    val prepared = Array.ofDim[PreparedTeam](worlds.size)
    for world <- came.left do prepared(world) = prepare(world)
    val batches =
      if together then WorldBatches.byEpisode(worlds, came.left, TimetableKernel.WORLDS)
      else WorldBatches.inOrder(came.left, LoopKernel.WORLDS)
    outcomes.flown = came.flown +
      LaneThreads.run(workers, batches, isCancelled, done => onProgress(came.flown + done)): (worker, some) =>
        worker.fly(worlds, prepared, some, together, outcomes)
    outcomes

  /** State of one thread, reused from batch to batch. Mutable. */
  private final class Worker:
    private val byForm  = mutable.HashMap.empty[(TeamForm, Boolean), Flight]
    private val stepped = mutable.HashMap.empty[Int, SteppedTeams]
    private val scalar  = ScalarTeam(timing, model)

    def fly(
        worlds: TeamWorlds,
        prepared: Array[PreparedTeam],
        numbers: Array[Int],
        share: Boolean,
        into: TeamOutcomes
    ): Unit =
      val filled   = mutable.LinkedHashSet.empty[Flight]
      val unfilled = Array.newBuilder[Int]
      for world <- numbers do
        prepared(world).form match
          case Some(form) if refusal(form, share, worlds.link(world)).isEmpty =>
            val first  = prepared(world).candidate
            val flight = byForm.getOrElseUpdate(
              (form, share),
              if share then
                val team = EpisodeTeam(form, first)
                Flight(_ => team)
              else Flight(BySlowest(LoopTeam(form, first, _))(_))
            )
            flight.add(world, prepared(world))
            filled += flight
          case _ if prepared(world).isStepped => unfilled += world
          case _                              =>
            into.set(world, scalar.fly(worlds.candidate(world), worlds.link(world), worlds.key(world)))
      for flight <- filled do flight.fly(worlds, into)
      for (count, some) <- unfilled.result().groupBy(worlds.candidate(_).engagement.agents.size) do
        stepped.getOrElseUpdate(count, steppedTeams(worlds.candidate(some(0)))).fly(worlds, some, into)

    private def steppedTeams(first: TeamCandidate) =
      SteppedTeams(timing, SteppedRollouts.of(model, first.engagement.agents).get)

  /** SIMD simulation of candidates of one form.
    *
    * @param team makes the team for links, by lane
    */
  private final class Flight(team: Array[Delays] => Team):
    private val worldOf = Array.ofDim[Int](TimetableKernel.WORLDS)
    private val held    = Array.ofDim[PreparedTeam](TimetableKernel.WORLDS)
    private var filled  = 0

    def add(world: Int, prepared: PreparedTeam): Unit =
      worldOf(filled) = world
      held(filled) = prepared
      filled += 1

    def fly(worlds: TeamWorlds, into: TeamOutcomes): Unit =
      // Lanes that no world needs fly the last one again.
      for lane <- filled until worldOf.length do
        worldOf(lane) = worldOf(filled - 1)
        held(lane) = held(filled - 1)
      val links  = worldOf.map(worlds.link)
      val flying = team(links)
      for lane <- worldOf.indices do
        val vehicles = held(lane).candidate.engagement.agents
        for (member, self) <- flying.members.zipWithIndex do
          member.take(lane, vehicles(self), held(lane).ofPolicies(self))
        flying.scores.take(lane, vehicles, held(lane).ofQuantities)
      flying.fly(links, worldOf.map(worlds.key), filled)
      for lane <- 0 until filled; number <- into.values.indices do
        into.values(number)(worldOf(lane)) = flying.scores.value(number, lane)
      filled = 0

  /** A team in many worlds, with its scores. */
  private abstract class Team(form: TeamForm):
    val scores: Scoreboard         = Scoreboard(form.scores, form.inSpace)
    protected val views: TeamViews = TeamViews(form.team)
    def members: Array[? <: TeamMember]

    /** Simulates one episode in each world.
      *
      * @param filled number of worlds that count
      */
    def fly(links: Array[Delays], keys: Array[Int], filled: Int): Unit

  /** A team whose worlds all have one episode. */
  private final class EpisodeTeam(form: TeamForm, first: TeamCandidate) extends Team(form):
    private val count              = form.team.count
    val members: Array[TeamAgents] = TeamAgents.of(first.engagement.agents, form.vehicles, views)
    private val kernel             = TimetableKernel(members.map(identity[TimetableAgents]), scores)

    def fly(links: Array[Delays], keys: Array[Int], filled: Int): Unit =
      val (link, key) = (links(0), keys(0))
      val made        =
        timetables.getOrMake((link, key, count, form.durationS, form.asksMore))(timetable(link, key, form))
      kernel.fly(made, filled)

  /** A team whose worlds have separate delays. */
  private final class LoopTeam(form: TeamForm, first: TeamCandidate, maxDelayS: Double) extends Team(form):
    private val loop                   = LoopLanes(timing, form.team.count, form.durationS, maxDelayS)
    val members: Array[LoopTeamAgents] =
      LoopTeamAgents.of(first.engagement.agents, loop, form.vehicles, views)
    private val kernel = LoopKernel(loop, members.map(identity[LaneAgents]), scores)

    def fly(links: Array[Delays], keys: Array[Int], filled: Int): Unit =
      kernel.fly(keys, links.map(_.asInstanceOf[TabledDelays]))
