package skein.environment

import java.nio.FloatBuffer
import skein.lanes.LearnerDuels
import skein.policy.{Policy, Role}
import skein.signal.SplitMix64

/** Up to [[LearnerDuels.WORLDS]] environments that run side by side over one link: delays and losses of
  * messages are equal in all of them. Mutable; one thread at a time.
  *
  * They begin a ''run'' together, which lasts as long as an episode. Where an episode ends earlier, by a
  * capture, the next begins immediately in the current run, and lasts until the run's end.
  *
  * @param first of the batch's environments
  * @param count of environments
  */
private final class DuelGroup(
    config: EnvironmentSettings.Resolved,
    timetables: EnvironmentTimetables,
    autoreset: Autoreset,
    first: Int,
    count: Int,
    into: EnvironmentBuffers
) extends EnvironmentGroup:
  import DuelGroup.*
  import EnvironmentGroup.{CaptureReward, Tolerance}
  import LearnerDuels.{FIELDS, WORLDS}

  private val settings  = config.settings
  private val vehicles  = config.learners.map(role => if role == Role.Evader then 0 else 1).toArray
  private val isOutside = Array(vehicles.contains(0), vehicles.contains(1))
  private val duels     =
    val evader  = if isOutside(0) then turning(settings.evaderRateRadPerS) else config.evader
    val pursuer = if isOutside(1) then SteeredPolicy(0) else config.pursuer
    LearnerDuels(config.duel, config.model, evader, pursuer, isOutside)

  private val seeds    = Array.ofDim[Long](WORLDS)
  private val episodes = Array.ofDim[Long](WORLDS)
  private val isDone   = Array.ofDim[Boolean](WORLDS)

  /** When each world's episode began, since the run's start, s. */
  private val beganS = Array.ofDim[Float](WORLDS)
  private val seen   = Array.ofDim[Float](FIELDS * WORLDS)
  private val startM = Array.ofDim[Float](WORLDS)
  private var runs   = 0L
  private var isOver = true

  /** Whether no decision has been made in this run. */
  private var isFirst = true

  def reset(newSeeds: Array[Long]): Unit =
    for world <- 0 until count do seed(world, newSeeds(first + world))
    if newSeeds(first) >= 0 then runs = 0
    startRun()
    for world <- 0 until count do clear(world)
    show(into.observations)

  def reset(newSeeds: Array[Long], mask: Array[Boolean]): Unit =
    val chosen = (0 until count).filter(world => mask(first + world))
    for world <- chosen do seed(world, newSeeds(first + world))
    if chosen.nonEmpty then
      val others = isDone.clone
      if isOver then startRun() else chosen.foreach(begin)
      System.arraycopy(others, 0, isDone, 0, WORLDS)
      for world <- chosen do
        isDone(world) = false
        clear(world)
      show(into.observations)

  private def seed(world: Int, seed: Long): Unit =
    if seed >= 0 then
      seeds(world) = seed
      episodes(world) = 0

  def misfit(): Int = into.misfit(first, count)

  def ended: Int =
    val world = if autoreset == Autoreset.Disabled then isDone.indexOf(true) else -1
    if world < 0 then -1 else first + world

  def step(): Unit =
    if isOver then nextRun()
    else
      var agent = 0
      while agent < vehicles.length do
        val vehicle = vehicles(agent)
        if duels.isDue(vehicle) then
          var world = 0
          while world < count do
            duels.tell(vehicle, world, commanded(vehicle, into.action(agent, first + world)))
            world += 1
        agent += 1
      duels.decide()
      // Scores before the first decision count for the first step.
      if !isFirst then duels.forgetScores()
      isFirst = false
      val goesOn = duels.flyOn()
      isOver = !goesOn || duels.scoredAtS + Tolerance >= settings.episodeS
      judge()

  private def commanded(vehicle: Int, action: Float): Float =
    val share = math.max(-1f, math.min(1f, action))
    val rate  = if vehicle == 1 then settings.turnRateRadPerS else settings.evaderRateRadPerS
    share * (if rate > 0 then rate else math.Pi).toFloat

  /** Computes rewards, and which episodes have ended. */
  private def judge(): Unit =
    // Both learners' rewards are of one distance: the pursuer's loss is the evader's gain.
    var world = 0
    var again = false
    while world < count do
      val number   = first + world
      val wasDone  = isDone(world)
      val captured = settings.captureRadiusM > 0 && duels.distanceLeast(world) <= settings.captureRadiusM
      val cost     = duels.distanceSum(world) / EnvironmentSettings.RewardM
      into.distance(number, duels.distance(world))
      into.time(number, duels.scoredAtS - beganS(world))
      if wasDone then
        // Its action was ignored; it shows its next episode's first observation.
        isDone(world) = false
        begin(world)
        clear(world)
      else
        var agent = 0
        while agent < vehicles.length do
          val loss = cost - (if captured then CaptureReward else 0)
          into.reward(agent, number, if vehicles(agent) == 1 then -loss else loss)
          agent += 1
        into.terminated(number, captured)
        into.truncated(number, isOver && !captured)
        isDone(world) = captured || isOver
      again |= isDone(world)
      world += 1
    autoreset match
      case Autoreset.SameStep if again =>
        show(into.finals)
        restartDone()
        show(into.observations)
      case _ => show(into.observations)

  /** Starts new episodes under `SameStep`: distance and time remain those of the ended episode. */
  private def restartDone(): Unit =
    if isOver then startRun()
    else for world <- 0 until count if isDone(world) do begin(world)
    java.util.Arrays.fill(isDone, false)

  /** Starts a run under `NextStep`: every environment's next episode begins with it. */
  private def nextRun(): Unit =
    // An environment that was restarted exactly at the run's end begins its episode once more.
    for world <- 0 until count if !isDone(world) do episodes(world) -= 1
    startRun()
    for world <- 0 until count do clear(world)
    show(into.observations)

  private def startRun(): Unit =
    duels.start(timetables(SplitMix64.seedOf(seeds(0), runs)), settings.episodeS.toFloat)
    runs += 1
    isOver = false
    isFirst = true
    java.util.Arrays.fill(isDone, false)
    for world <- 0 until count do begin(world)
    if !duels.flyOn() then
      throw IllegalStateException(
        "nothing is decided in an episode: are the answers later than the time-out?"
      )
    java.util.Arrays.fill(beganS, 0f)

  private def begin(world: Int): Unit =
    val start = Start.of(config.duel, settings.startWithinM, SplitMix64.seedOf(seeds(world), episodes(world)))
    episodes(world) += 1
    beganS(world) = duels.scoredAtS
    startM(world) = start.distanceM
    duels.restart(world, 0, start.evaderNorthM, start.evaderEastM, start.evaderHeadingRad)
    duels.restart(world, 1, start.pursuerNorthM, start.pursuerEastM, start.pursuerHeadingRad)

  private def clear(world: Int): Unit = into.begun(first + world, startM(world))

  /** Writes the observations of the learners that are due; the others' stay unchanged. */
  private def show(to: FloatBuffer): Unit =
    var agent = 0
    while agent < vehicles.length do
      val isDue = duels.isDue(vehicles(agent))
      var world = 0
      while world < count do
        into.due(agent, first + world, isDue)
        world += 1
      if isDue then
        duels.observe(vehicles(agent), seen)
        var field = 0
        while field < FIELDS do
          to.put((agent * FIELDS + field) * into.count + first, seen, field * WORLDS, count): Unit
          field += 1
      agent += 1

private object DuelGroup:
  private def turning(rateRadPerS: Double): Policy =
    if rateRadPerS > 0 then SteeredPolicy(0) else Turned(0)
