package skein.lanes

import java.util.IdentityHashMap
import scala.collection.mutable
import scala.collection.mutable.ArrayBuffer
import skein.forward.{Delays, LoopObserver, LoopTiming, Rollout, VelocityResponse}
import skein.policy.TeamPolicy
import skein.scenario.Positions
import skein.simd.LaneMath
import skein.units.Expect

/** Flies many candidates of a team under one loop's timing, on all cores. Candidates whose policies and
  * quantities are formulas fly by lanes ([[TimetableKernel]]), all of an episode by one [[Timetable]], which
  * is made once; others by the scalar reference ([[Rollout]]), which is told. Which engine flies a world
  * depends on its candidate alone, so results do not depend on threads, on a call's other worlds or on their
  * order. One call at a time.
  *
  * @param areShared whether several candidates meet the same episode. Where none do, the scalar reference
  *   flies them: it is what makes a timetable, and that would be made for one world
  */
final class TeamBatch(
    timing: LoopTiming,
    model: VelocityResponse,
    threads: Int = Runtime.getRuntime.availableProcessors,
    areShared: Boolean = true
):
  require(threads > 0, s"threads must be positive, got $threads")

  private val timetables = Timetables(MostBytes)
  private val workers    = Vector.fill(threads)(Worker())

  /** Which engine flies such a team, and why, in a line for the user. */
  def engine(candidate: TeamCandidate): String = lanesOf(candidate) match
    case Right(_)     => s"SIMD, ${LaneMath.LANES} candidates of an episode at a time"
    case Left(reason) => s"scalar: $reason"

  def fliesByLanes(candidate: TeamCandidate): Boolean = lanesOf(candidate).isRight

  private def lanesOf(candidate: TeamCandidate): Either[String, Form] =
    val engagement = candidate.engagement
    val policies   = engagement.agents.map(_.policy).collect { case team: TeamPolicy => team }
    for
      _        <- Expect.that(areShared)("every world has delays of its own")
      _        <- LaneSupport.present
      vehicles <- LaneDynamics.under(timing, model, engagement.agents)
      _        <- Expect.that(policies.size == engagement.agents.size):
        "a policy plays against one opponent; the lanes fly such policies in duels alone"
      team   <- TeamLanes.of(policies).left.map(refused => s"a policy is no formula: ${refused.getMessage}")
      scores <- ScoreLanes
        .of(candidate.judged, policies.size)
        .left
        .map(refused => s"a quantity is no formula: ${refused.getMessage}")
    yield Form(
      team,
      scores,
      engagement.durationS,
      engagement.agents.map(_.altitudeDownM)
    )(vehicles)

  /** Flies all worlds, unless it is cancelled.
    *
    * @param isCancelled asked before each batch, from any thread; batches that fly already end
    * @throws InterruptedException if the caller is interrupted; the batches that fly already have ended then
    */
  def fly(worlds: TeamWorlds, isCancelled: () => Boolean = () => false): TeamOutcomes =
    val known    = IdentityHashMap[TeamCandidate, Prepared]()
    val prepared = Array.tabulate(worlds.size): world =>
      known.computeIfAbsent(worlds.candidate(world), Prepared(_))
    val judged   = if worlds.size == 0 then 0 else worlds.candidate(0).judged.size
    val outcomes = TeamOutcomes(Vector.fill(judged)(Array.ofDim[Float](worlds.size)))
    val batches  = WorldBatches.byEpisode(worlds.size, worlds.link, worlds.key, TimetableKernel.WORLDS)
    outcomes.flown = LaneThreads.run(workers, batches, isCancelled): (worker, numbers) =>
      worker.fly(worlds, prepared, numbers, outcomes)
    outcomes

  /** A candidate with the numbers that it differs by from others of its form. */
  private final class Prepared(val candidate: TeamCandidate):
    private val agents                    = candidate.engagement.agents
    val form: Option[Form]                = lanesOf(candidate).toOption
    val ofPolicies: Vector[Array[Double]] = form.toVector.flatMap: form =>
      agents.zipWithIndex.map((agent, self) =>
        form.team.parametersOf(self, agent.policy.asInstanceOf[TeamPolicy])
      )
    val ofQuantities: Vector[Array[Double]] = form.toVector.flatMap: form =>
      candidate.judged.zipWithIndex.map((each, number) => form.scores.parametersOf(number, each.quantity))

  /** One per thread. Mutable. */
  private final class Worker:
    private val byForm = mutable.HashMap.empty[Form, Flight]
    private val scalar = ScalarTeam(timing, model)

    def fly(worlds: TeamWorlds, prepared: Array[Prepared], numbers: Array[Int], into: TeamOutcomes): Unit =
      val filled = mutable.LinkedHashSet.empty[Flight]
      for world <- numbers do
        prepared(world).form match
          case Some(form) =>
            val flight = byForm.getOrElseUpdate(form, Flight(form, prepared(world).candidate))
            flight.add(world, prepared(world))
            filled += flight
          case None =>
            val values = scalar.fly(prepared(world).candidate, worlds.link(world), worlds.key(world))
            for (value, number) <- values.zipWithIndex do into.values(number)(world) = value.toFloat
      for flight <- filled do flight.fly(worlds.link(numbers(0)), worlds.key(numbers(0)), into)

  /** Candidates of one form, by lanes. */
  private final class Flight(form: Form, first: TeamCandidate):
    private val count  = form.team.count
    private val views  = TeamViews(form.team)
    private val agents = Array.tabulate(count): self =>
      TeamAgents(self, first.engagement.agents(self), form.vehicles, views)
    private val scores  = Scoreboard(form.scores)
    private val kernel  = TimetableKernel(agents.map(identity[TimetableAgents]), scores)
    private val worldOf = Array.ofDim[Int](TimetableKernel.WORLDS)
    private var last    = Option.empty[Prepared]
    private var filled  = 0

    def add(world: Int, prepared: Prepared): Unit =
      worldOf(filled) = world
      last = Some(prepared)
      put(filled, prepared)
      filled += 1

    private def put(lane: Int, prepared: Prepared): Unit =
      val vehicles = prepared.candidate.engagement.agents
      for self <- 0 until count do agents(self).take(lane, vehicles(self), prepared.ofPolicies(self))
      scores.take(lane, vehicles, prepared.ofQuantities)

    def fly(link: Delays, key: Int, into: TeamOutcomes): Unit =
      // Lanes that no world needs fly the last one again.
      for prepared <- last; lane <- filled until TimetableKernel.WORLDS do put(lane, prepared)
      val timetable = timetables.getOrMake((link, key, count, form.durationS)):
        Timetable.of(count, form.durationS, timing, link, key, form.vehicles)
      kernel.fly(timetable, filled)
      for lane <- 0 until filled; number <- into.values.indices do
        into.values(number)(worldOf(lane)) = scores.value(number, lane)
      filled = 0

  /** Candidates of one form fly side by side. */
  private final case class Form(
      team: TeamLanes,
      scores: ScoreLanes,
      durationS: Double,
      altitudesDownM: Vector[Double]
  )(val vehicles: LaneDynamics)

  /** Of some 90 kB for each vehicle and minute; a search flies the same few episodes again and again. */
  private inline val MostBytes = 256L << 20

/** The scalar reference for what a team is judged by. Mutable. */
private[skein] final class ScalarTeam(timing: LoopTiming, model: VelocityResponse):
  private var last: (TeamCandidate, Delays) = (null, null)
  private var rollout: Rollout              = null

  /** What one episode comes to, by what is judged. */
  def fly(candidate: TeamCandidate, link: Delays, key: Int): Vector[Double] =
    val asked = (candidate, link)
    if asked != last then
      last = asked
      rollout = Rollout(candidate.engagement, timing, link, model)
    val downM    = IArray.from(candidate.engagement.agents.map(_.altitudeDownM))
    val count    = downM.length
    val values   = candidate.judged.map(_ => ArrayBuffer.empty[(Double, Double)])
    val observer = new LoopObserver:
      private val northM, eastM = Array.ofDim[Double](count)
      override def scored(timeS: Double, vehicle: Int, x: Double, y: Double): Unit =
        northM(vehicle) = x; eastM(vehicle) = y
        if vehicle == count - 1 && candidate.judged.exists(_.counts(timeS)) then
          val places = Positions(IArray.from(northM), IArray.from(eastM), downM)
          for (each, found) <- candidate.judged.zip(values) if each.counts(timeS) do
            found += ((timeS, each.quantity.of(places)))
    rollout.fly(key, observer = observer): Unit
    candidate.judged.zip(values).map((each, found) => each.of(found.toVector))
