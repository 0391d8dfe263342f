package skein.lanes

import java.util.IdentityHashMap
import scala.collection.mutable
import skein.forward.{DelayTable, Delays, Engagement, LoopTiming, VelocityResponse}
import skein.lanes.loop.BySlowest
import skein.lanes.timetable.{TimetableKernel, Timetables}
import skein.simd.LaneMath
import skein.units.Expect

/** Simulates many candidates of a team under one loop's timing, on all cores: the entry point of forward
  * simulation for searches and maps. A duel is a team of two.
  *
  * Candidates whose policies and quantities are formulas run on SIMD: worlds that share episodes by
  * [[TimetableKernel]], all of an episode by one [[skein.lanes.timetable.Timetable]], which is computed once;
  * others by [[skein.lanes.loop.LoopKernel]]. Two opponents that command headings decide by
  * [[skein.lanes.policy.OpponentLanes]], others by [[skein.lanes.policy.TeamLanes]]. Quadrotors and MuJoCo
  * bodies of other teams are stepped together under the scalar loops ([[SteppedRollouts]]). Everything else
  * runs on the scalar reference ([[skein.forward.Rollout]]); the engine's text then states why.
  * `docs/engines.md` has the table. The engine of a world depends only on its candidate, its link and
  * `shareEpisodes`, so results do not depend on threads, on a call's other worlds or on their order. One call
  * at a time.
  *
  * @param accelerator simulates the candidates of [[Worlds.episodesOfEach]] that are formulas, if it supports
  *   the loop and the vehicles
  * @param isReference uses only the scalar reference, to compare others with it
  */
final class TeamBatch(
    timing: LoopTiming,
    model: VelocityResponse,
    threads: Int = Runtime.getRuntime.availableProcessors,
    accelerator: Option[Accelerator] = None,
    isReference: Boolean = false
):
  require(threads > 0, s"threads must be positive, got $threads")

  private val episodes   = Episodes(timing)
  private val timetables = Timetables()
  private val workers    = Vector.fill(threads)(Worker())

  private val forms = TeamForms(timing, model, isReference)

  private val accelerated: Option[Either[String, AcceleratedTeams]] =
    accelerator.map(_.teams(timing, model, threads, episodes))

  /** The engine for such a team.
    *
    * @param shareEpisodes see [[TeamWorlds.shareEpisodes]]; on a GPU, only worlds with
    *   [[Worlds.episodesOfEach]] run
    * @param links the worlds' links: SIMD does not support delays that are long for the period, or recorded
    */
  def engine(candidate: TeamCandidate, shareEpisodes: Boolean, links: Seq[Delays]): Engine =
    val form  = forms.of(candidate)
    val asked = (form, shareEpisodes, links)
    if found._1 == asked then found._2
    else
      val engine = engineOf(candidate, form, shareEpisodes, links)
      if engine.fliesByLanes then found = (asked, engine)
      engine

  /** The arguments and the result of the last call for SIMD, since a search queries the engine for every
    * candidate.
    */
  @volatile private var found: ((Either[String, TeamForm], Boolean, Seq[Delays]), Engine) = (null, null)

  private def engineOf(
      candidate: TeamCandidate,
      form: Either[String, TeamForm],
      shareEpisodes: Boolean,
      links: Seq[Delays]
  ): Engine =
    def together(form: TeamForm) = shareEpisodes || episodes.areOne(form)
    def refused(by: Delays)      = form.toOption.flatMap(form => refusal(form, together(form), by))
    val worlds                   = if form.exists(together) then "candidates of an episode" else "worlds"
    Engine.of(
      // A team that SIMD does not support over the fastest link, it does not support over any.
      form.flatMap(_ => refused(DelayTable.none).toLeft(s"${LaneMath.LANES} $worlds at a time")),
      links.map(refused),
      steppedOf(candidate.engagement),
      accelerator.zip(accelerated).map: (by, offer) =>
        for
          _ <- form.toOption.flatMap(_.refusedByGpu).toLeft(())
          _ <- offer
          _ <- Expect.that(form.exists(together))("the GPU flies candidates that share episodes")
        yield by.engine,
      form.fold(_ => 1, _.policies.sideBySide)
    )

  private def steppedOf(engagement: Engagement): Option[Engine] =
    SteppedRollouts
      .engine(model, engagement.agents)
      .filterNot: _ =>
        isReference || engagement.hasCars || engagement.agents.exists(_.eye.isDefined) ||
          model.isSpatial && engagement.climbs.isDefined

  /** Why SIMD does not support worlds of a form with these delays.
    *
    * @param together whether they share their episodes
    */
  private def refusal(form: TeamForm, together: Boolean, link: Delays): Option[String] =
    if together then None
    else
      val ends = Expect.that(!form.scores.hasEnd || !form.sees):
        "a scenario with an end of its own and a sensor uses SIMD only if candidates share episodes"
      val seen =
        for
          _ <- Expect.that(form.vehicles.forall(_.fliesAlone)):
            "quadrotors with a sensor use SIMD only if candidates share episodes"
          _ <- Expect.that(!timing.isInstanceOf[LoopTiming.Paused]):
            "a sensor under a loop that pauses the world uses SIMD only if candidates share episodes"
          _ <- Expect.that(form.policies.eyes.size == 1):
            "two vehicles that see each other by sensors use SIMD only if candidates share episodes"
        yield ()
      ends.left.toOption.orElse(seen.left.toOption.filter(_ => form.sees)).orElse:
        LoopSupport.refusal(timing, form.vehicles, link)

  /** Simulates all worlds, unless it is cancelled.
    *
    * @param onProgress called with the number of worlds done, after each batch, by one thread at a time
    * @param isCancelled polled before each batch and in between, from any thread; running batches finish, or
    *   are abandoned if vehicles are stepped together
    * @throws InterruptedException if the caller is interrupted; running batches have finished then
    */
  def fly(
      worlds: TeamWorlds,
      onProgress: Int => Unit = _ => (),
      isCancelled: () => Boolean = () => false
  ): TeamOutcomes =
    val known                              = IdentityHashMap[TeamCandidate, PreparedTeam]()
    var last: PreparedTeam                 = null
    def prepare(number: Int): PreparedTeam =
      val candidate = worlds.candidate(number)
      if last == null || (last.candidate ne candidate) then
        last = known.computeIfAbsent(
          candidate,
          PreparedTeam(_, forms.of(candidate), steppedOf(candidate.engagement))
        )
      last
    val judged   = if worlds.size == 0 then 0 else worlds.candidate(0).judged.size
    val outcomes = TeamOutcomes(Vector.fill(judged)(Array.ofDim[Float](worlds.size)))
    val came     = accelerated
      .flatMap(_.toOption)
      .filter(_ => worlds.shareEpisodes && worlds.episodesOfEach > 0)
      .fold(Accelerated(0, Array.range(0, worlds.size)))(
        _.fly(worlds, prepare, outcomes, onProgress, isCancelled)
      )
    val prepared = Array.ofDim[PreparedTeam](worlds.size)
    for world <- came.left do prepared(world) = prepare(world)
    val most    = came.left.headOption.fold(1)(world => batchOf(prepared(world)))
    val groups  = if worlds.shareEpisodes then byEpisode(worlds, came.left) else Seq(came.left)
    val batches = groups.iterator.flatMap(_.grouped(most)).toArray
    outcomes.flown = came.flown +
      LaneThreads.run(workers, batches, isCancelled, done => onProgress(came.flown + done)): (worker, some) =>
        worker.fly(worlds, prepared, some, outcomes)
    outcomes

  /** Groups worlds that share one key and one link. */
  private def byEpisode(worlds: TeamWorlds, numbers: Array[Int]): Iterable[Array[Int]] =
    val groups = mutable.LinkedHashMap.empty[(Delays, Int), mutable.ArrayBuilder.ofInt]
    for world <- numbers do
      groups.getOrElseUpdate((worlds.link(world), worlds.key(world)), mutable.ArrayBuilder.ofInt()) += world
    groups.values.map(_.result())

  /** Number of worlds that a thread takes together, given one of them. */
  private def batchOf(team: PreparedTeam): Int =
    if team.form != null then TimetableKernel.WORLDS
    else if team.isStepped then SteppedRollouts.worldsOf(model, team.vehicles.size)
    else ScalarTeam.Worlds

  /** State of one thread, reused from batch to batch. Mutable. */
  private final class Worker:
    private val byForm  = mutable.HashMap.empty[(TeamForm, Boolean), Flight]
    private val stepped = mutable.HashMap.empty[Int, SteppedTeams]
    private val scalar  = ScalarTeam(timing, model)

    // Those of the previous world: neighbours often have one form and link.
    private var lastForm: TeamForm = null
    private var lastLink: Delays   = null
    private var lastFlight: Flight = null
    private var lastShares         = false

    def fly(
        worlds: TeamWorlds,
        prepared: Array[PreparedTeam],
        numbers: Array[Int],
        into: TeamOutcomes
    ): Unit =
      val filled   = mutable.ArrayBuffer.empty[Flight]
      val unfilled = Array.newBuilder[Int]
      for world <- numbers do
        val team   = prepared(world)
        val flight = if team.form == null then null else flightOf(team.form, team, worlds, world)
        if flight != null then
          if flight.add(world, team) then filled += flight
        else if team.isStepped then unfilled += world
        else into.set(world, scalar.fly(team.candidate, worlds.link(world), worlds.key(world)))
      for flight <- filled do flight.fly(worlds, into)
      for (count, some) <- unfilled.result().groupBy(prepared(_).vehicles.size) do
        stepped.getOrElseUpdate(count, steppedTeams(prepared(some(0)))).fly(worlds, some, into)

    /** The SIMD simulation for a world; null if SIMD does not support it. */
    private def flightOf(form: TeamForm, team: PreparedTeam, worlds: TeamWorlds, world: Int): Flight =
      val link   = worlds.link(world)
      val shares = worlds.shareEpisodes
      if (form ne lastForm) || (link ne lastLink) || shares != lastShares then
        lastForm = form
        lastLink = link
        lastShares = shares
        val together = shares || episodes.areOne(form)
        lastFlight =
          if refusal(form, together, link).isDefined then null
          else byForm.getOrElseUpdate((form, together), newFlight(form, team.candidate, together))
      lastFlight

    private def newFlight(form: TeamForm, first: TeamCandidate, together: Boolean) =
      if together then
        val teams = EpisodeTeams(form, first, episodes, timetables)
        Flight((_, _) => teams)
      else
        val teams = BySlowest(LoopTeams(form, first, timing, _))
        Flight((worlds, worldOf) => teams(worldOf.map(worlds.link)))

    private def steppedTeams(first: PreparedTeam) =
      SteppedTeams(timing, SteppedRollouts.of(model, first.vehicles).get)

  /** SIMD simulation of candidates of one form.
    *
    * @param teams yields the teams that simulate worlds, given the worlds' indices
    */
  private final class Flight(teams: (TeamWorlds, Array[Int]) => LaneTeams):
    private val worldOf = Array.ofDim[Int](TimetableKernel.WORLDS)
    private val held    = Array.ofDim[PreparedTeam](TimetableKernel.WORLDS)
    private var filled  = 0

    /** @return whether it is the first world since the last flight */
    def add(world: Int, prepared: PreparedTeam): Boolean =
      worldOf(filled) = world
      held(filled) = prepared
      filled += 1
      filled == 1

    def fly(worlds: TeamWorlds, into: TeamOutcomes): Unit =
      // Unused lanes simulate the last world again.
      for lane <- filled until worldOf.length do
        worldOf(lane) = worldOf(filled - 1)
        held(lane) = held(filled - 1)
      val flying = teams(worlds, worldOf)
      for lane <- worldOf.indices do flying.take(lane, held(lane))
      flying.fly(worlds, worldOf, filled)
      flying.tell(worldOf, filled, into)
      filled = 0
