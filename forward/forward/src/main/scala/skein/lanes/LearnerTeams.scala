package skein.lanes

import skein.forward.{Delays, LoopTiming, VelocityResponse}
import skein.lanes.policy.OpponentLanes
import skein.lanes.score.{OfMoment, Scoreboard}
import skein.lanes.timetable.{Timetable, TimetableAgents, TimetableKernel, Timetables}
import skein.signal.SplitMix64
import skein.simd.WorldRandom
import skein.units.eachBelow

/** Teams with learners in many worlds by one timetable, with the results of [[TeamBatch]]. Allocates nothing
  * after construction, unless a timetable needs more slots than any before.
  *
  * @param learners indices of the vehicles that decide by [[LearnerPolicy]]
  * @param worlds number of worlds that count
  */
final class LearnerTeams private[lanes] (
    form: TeamForm,
    team: TeamCandidate,
    learners: Array[Int],
    worlds: Int,
    timetableOf: Long => Timetable
) extends LearnerWorlds:
  import LearnerTeams.ToleranceS
  import TimetableKernel.{DECIDE, END, WORLDS}

  private val members = LaneTeams.inEpisode(form, team.engagement.agents)
  private val scores  = Scoreboard(form.scores, form.altitudesDownM)
  private val kernel  = TimetableKernel(members.map(identity[TimetableAgents]), scores)
  private val passing =
    team.quantities.indices.filter(team.quantities(_).reduction != OfMoment.Newest).toArray
  private val isOfTwo = form.policies.isInstanceOf[OpponentLanes]
  private val spaces  = learners.map(team.engagement.agents(_).policy).collect:
    case policy: LearnerPolicy => policy.space
  private val learns = Array.tabulate(form.count)(learners.contains(_))

  private var timetable: Timetable   = null
  private var operations: Array[Int] = null

  /** Index of the timetable's next operation, and end of the decisions that are due. */
  private var next, dueUntil = 0

  locally:
    val prepared = PreparedTeam(team, Right(form), None)
    for world <- 0 until WORLDS do
      for self <- members.indices do members(self).take(world, prepared.numbers(self))
      if form.hasParameters then scores.take(world, prepared.ofScores)

  def restartAlone: Boolean = true

  def start(draw: Long, untilS: Float): Unit =
    timetable = timetableOf(draw)
    operations = timetable.operations
    scores.untilS = untilS + ToleranceS
    next = 0
    dueUntil = 0
    if form.isSensed then
      // A world's errors must not depend on which others there are.
      val seeds = Array.tabulate(WORLDS)(world => if world == 0 then draw else SplitMix64.seedOf(draw, world))
      for self <- members.indices do members(self).vehicles.seed(seeds, self)
    kernel.start(timetable, worlds)

  def restart(world: Int, vehicle: Int, northM: Float, eastM: Float, headingRad: Float): Unit =
    val body = members(vehicle).vehicles
    body.startX(world) = northM
    body.startY(world) = eastM
    members(vehicle).restart(world, headingRad)

  def flyOn(): Boolean =
    while next < timetable.size && !learnsAt(next) do
      kernel.perform(next)
      next += 1
    dueUntil = next
    // Several learners decide together if no event lies between their decisions and none knows another's
    // pending command.
    while dueUntil < timetable.size && (isEnd(dueUntil) || learnsAt(dueUntil) && !knowsPending(dueUntil)) do
      dueUntil += 1
    next < timetable.size

  private def learnsAt(operation: Int) =
    val field = operation * Timetable.Fields
    operations(field) == DECIDE && learns(operations(field + 1))

  /** Whether this only checks whether the flight has ended. */
  private def isEnd(operation: Int) = operations(operation * Timetable.Fields) == END

  private def knowsPending(operation: Int): Boolean =
    var before = next
    while before < operation do
      val field     = before * Timetable.Fields
      val vehicle   = operations(field + 1)
      val isPending = vehicle == operations(operation * Timetable.Fields + 1) ||
        knownPlace(operation, vehicle) == operations(field + 5)
      if isPending && !isEnd(before) then return true
      before += 1
    false

  /** The slot of another vehicle's heading that a decision knows. */
  private def knownPlace(operation: Int, vehicle: Int) =
    val known = operations(operation * Timetable.Fields + 3)
    if isOfTwo then known else timetable.more.heading(known, vehicle)

  def isDue(learner: Int): Boolean = operationOf(learner) >= 0

  private def operationOf(learner: Int): Int =
    var operation = next
    while operation < dueUntil do
      if !isEnd(operation) && operations(operation * Timetable.Fields + 1) == learners(learner) then
        return operation
      operation += 1
    -1

  def observe(learner: Int, into: Array[Float]): Unit =
    kernel.observe(operationOf(learner))
    val space = spaces(learner)
    val from  = members(learners(learner)).nextMemory
    System.arraycopy(from, space.outputs * WORLDS, into, 0, space.inputs * WORLDS)

  def act(learner: Int, component: Int, numbers: Array[Float]): Unit =
    System.arraycopy(numbers, 0, members(learners(learner)).memory, component * WORLDS, worlds)

  def decide(): Unit =
    while next < dueUntil do
      kernel.perform(next)
      next += 1

  def hasEnded(world: Int): Boolean = scores.hasEnded(world)

  def scoredAtS: Float = scores.scoredAtS

  def soFar(number: Int, into: Array[Float]): Unit = scores.soFar(number, into)

  def forgetScores(): Unit =
    eachBelow(passing.length): i =>
      scores.forget(passing(i))

  def forgetScores(world: Int): Unit =
    for number <- passing do scores.forgetIn(world, number)
    scores.goOn(world)

object LearnerTeams:
  private val ToleranceS = 1e-4f

  /** Number of flights over the link from which delays are drawn; each is computed once, and takes some 200
    * kB for a minute of two vehicles.
    */
  private val Flights = 128

  /** The key of a world of [[TeamBatch]] with a run's delays. */
  def keyOf(draw: Long): Int = WorldRandom.key(1, 0, ((draw >>> 1) % Flights).toInt)

  /** Makes teams under one loop's timing, over one link. Thread-safe.
    *
    * @param timing the loop's timing
    * @param model how the vehicles respond to commands
    */
  final class Maker(timing: LoopTiming, link: Delays, model: VelocityResponse):
    private val forms      = TeamForms(timing, model)
    private val episodes   = Episodes(timing)
    private val timetables = Timetables()

    /** The reason why SIMD does not support a team; None if it does. */
    def refusal(team: TeamCandidate): Option[String] = formOf(team).left.toOption

    /** @param learners indices of the vehicles that decide by [[LearnerPolicy]]
      * @param worlds number of worlds, at most [[LearnerWorlds.Most]]
      * @return Left says why SIMD does not support them
      */
    def of(team: TeamCandidate, learners: Vector[Int], worlds: Int): Either[String, LearnerTeams] =
      formOf(team).map(form => LearnerTeams(form, team, learners.toArray, worlds, timetableOf(form, _)))

    private def formOf(team: TeamCandidate) = forms
      .of(team)
      .filterOrElse(
        form => !form.scores.asksTime && !form.policies.asksTime,
        "a measure or a policy depends on the time, and each world restarts at its own"
      )

    private def timetableOf(form: TeamForm, draw: Long): Timetable =
      val key = keyOf(draw)
      // More draws than keys, so these are not kept.
      if !episodes.areOne(form) && form.vehicles.exists(_.sensors.exists(_.ofMissing.isDefined)) then
        episodes.timetable(link, key, form, Some(draw))
      else
        timetables.getOrMake(episodes.nameOf(link, key, form))(episodes.timetable(link, key, form))
