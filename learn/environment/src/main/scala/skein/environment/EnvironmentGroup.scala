package skein.environment

import java.nio.FloatBuffer
import skein.lanes.LearnerWorlds
import skein.signal.SplitMix64
import skein.units.eachBelow

/** Environments that run simultaneously over one link: delays and losses of messages are equal in all of
  * them, and so is which readings are missing. Mutable; one thread at a time.
  *
  * They begin a ''run'' together, which lasts as long as an episode. If an episode ends earlier, by a capture
  * or because the scenario has ended, the next begins immediately in the current run, and lasts until the
  * run's end; worlds that cannot restart alone begin a new run.
  *
  * @param learning indices of the learners' vehicles
  * @param first index of the group's first environment in the batch; the others follow at a distance of
  *   `stride`
  */
private final class EnvironmentGroup(
    side: LearnerSide,
    learning: Vector[Int],
    worlds: LearnerWorlds,
    autoreset: Autoreset,
    first: Int,
    stride: Int,
    count: Int,
    into: EnvironmentBuffers
) extends AutoCloseable:
  import EnvironmentGroup.{CaptureReward, Tolerance}
  import LearnerWorlds.Most

  private val settings   = side.settings
  private val vehicles   = learning.toArray
  private val agents     = vehicles.length
  private val components = settings.space.outputs
  private val fields     = settings.space.inputs

  /** What an action of 1 stands for, by learner and component. */
  private val most     = vehicles.map(vehicle => Array(side.mostTurn(vehicle)._2, settings.climbMps.toFloat))
  private val gains    = vehicles.map(CaptureReward * side.captureSign(_))
  private val apart    = side.apart(learning).size
  private val weights  = vehicles.indices.map(side.weights(learning, _)).toArray
  private val starts   = Starts(side)
  private val seeds    = Array.ofDim[Long](count)
  private val episodes = Array.ofDim[Long](count)
  private val isDone   = Array.ofDim[Boolean](count)

  /** When each world's episode began, since the run's start, s. */
  private val beganS = Array.ofDim[Float](count)
  private val seen   = Array.ofDim[Float](fields * Most)

  // Of the present step, by world.
  private val actions   = Array.ofDim[Float](agents, components, Most)
  private val row, cost = Array.ofDim[Float](Most)
  private val isCapture = Array.ofDim[Boolean](count)
  private val startM    = Array.ofDim[Float](agents * count)
  private val wasDue    = Array.ofDim[Boolean](agents)
  private var runs      = 0L
  private var isOver    = true

  /** Whether no decision has been made in this run. */
  private var isFirst = true

  private def numberOf(world: Int) = first + world * stride

  /** Resets every environment.
    *
    * @param newSeeds seeds of the whole batch; a negative one continues the environment's own sequence
    */
  def reset(newSeeds: Array[Long]): Unit =
    for world <- 0 until count do seed(world, newSeeds(numberOf(world)))
    if newSeeds(first) >= 0 then runs = 0
    startRun()
    for world <- 0 until count do clear(world)
    show(into.observations)

  /** Resets each environment that `mask` selects, with its entry in the seeds. */
  def reset(newSeeds: Array[Long], mask: Array[Boolean]): Unit =
    val chosen = (0 until count).filter(world => mask(numberOf(world)))
    for world <- chosen do seed(world, newSeeds(numberOf(world)))
    if chosen.nonEmpty then
      val others = isDone.clone
      if isOver || !worlds.restartAlone then
        startRun()
        // The episodes of the others begin with their own reset.
        for world <- 0 until count if !chosen.contains(world) do episodes(world) -= 1
      else chosen.foreach(begin)
      System.arraycopy(others, 0, isDone, 0, count)
      for world <- chosen do
        isDone(world) = false
        clear(world)
      show(into.observations)

  private def seed(world: Int, seed: Long): Unit =
    if seed >= 0 then
      seeds(world) = seed
      episodes(world) = 0

  /** Reads the actions; returns an environment whose action is not finite, or −1. */
  def misfit(): Int =
    var agent = 0
    while agent < agents do
      if worlds.isDue(agent) then
        var component = 0
        while component < components do
          val read = actions(agent)(component)
          into.read(into.actions, agent * components + component, first, stride, read, count)
          var world = 0
          while world < count do
            if !(Math.abs(read(world)) <= Float.MaxValue) then return numberOf(world)
            world += 1
          component += 1
      agent += 1
    -1

  /** An environment that has ended and was not reset, or −1. */
  def ended: Int =
    val world = if autoreset == Autoreset.Disabled then isDone.indexOf(true) else -1
    if world < 0 then -1 else numberOf(world)

  /** Makes the decisions whose actions were read. */
  def step(): Unit =
    if isOver then nextRun()
    else
      eachBelow(agents): agent =>
        if worlds.isDue(agent) then act(agent)
      worlds.decide()
      // Scores before the first decision count for the first step.
      if !isFirst then worlds.forgetScores()
      isFirst = false
      val goesOn = worlds.flyOn()
      isOver = !goesOn || worlds.scoredAtS + Tolerance >= settings.episodeS
      eachBelow(agents): agent =>
        reward(agent)
      judge()

  private def act(agent: Int): Unit =
    eachBelow(components): component =>
      val numbers = actions(agent)(component)
      eachBelow(count): world =>
        numbers(world) = math.max(-1f, math.min(1f, numbers(world))) * most(agent)(component)
      worlds.act(agent, component, numbers)

  /** Writes a learner's rewards and distances, and notes captures. */
  private def reward(agent: Int): Unit =
    val distance = 2 * agent.min(apart - 1)
    worlds.soFar(distance, row)
    // Nothing may have been scored yet.
    if !row(0).isNaN then into.write(into.distances, agent, first, stride, row, 0, count)
    java.util.Arrays.fill(cost, 0f)
    eachBelow(weights(agent).length): term =>
      val weight = weights(agent)(term)
      if weight != 0 then
        worlds.soFar(2 * apart + term, row)
        eachBelow(count): world =>
          cost(world) -= weight * row(world) / EnvironmentSettings.RewardM
    if agent == 0 then java.util.Arrays.fill(isCapture, false)
    if settings.captureRadiusM > 0 then
      val radiusM = settings.captureRadiusM.toFloat
      worlds.soFar(distance + 1, row)
      eachBelow(count): world =>
        if row(world) <= radiusM then
          isCapture(world) = true
          cost(world) += gains(agent)
    into.write(into.rewards, agent, first, stride, cost, 0, count)

  /** Determines which episodes have ended. */
  private def judge(): Unit =
    val scoredAtS = worlds.scoredAtS
    var again     = false
    eachBelow(count): world =>
      val number = numberOf(world)
      into.time(number, scoredAtS - beganS(world))
      if isDone(world) then
        // Its action was ignored; it shows its next episode's first observation.
        isDone(world) = false
        begin(world)
        clear(world)
      else
        val isEnded = isCapture(world) || worlds.hasEnded(world)
        into.terminated(number, isEnded)
        into.truncated(number, isOver && !isEnded)
        isDone(world) = isEnded || isOver
      again |= isDone(world)
    autoreset match
      case Autoreset.SameStep if again =>
        showFinals()
        val ended = isDone.clone
        restartDone()
        for world <- 0 until count if ended(world) do hide(world)
        show(into.observations)
      case Autoreset.NextStep if again && !worlds.restartAlone =>
        isOver = true
        show(into.observations)
      case _ => show(into.observations)

  /** Starts new episodes under `SameStep`: distance and time remain those of the ended episode. */
  private def restartDone(): Unit =
    if isOver || !worlds.restartAlone then startRun()
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
    worlds.start(SplitMix64.seedOf(seeds(0), runs), settings.episodeS.toFloat)
    runs += 1
    isOver = false
    isFirst = true
    java.util.Arrays.fill(isDone, false)
    java.util.Arrays.fill(beganS, 0f)
    for world <- 0 until count do begin(world)
    if !worlds.flyOn() then
      throw IllegalStateException(
        if worlds.hasEnded(0) then "the scenario is over before a learner decides"
        else "nothing is decided in an episode: are the answers later than the time-out?"
      )
    java.util.Arrays.fill(beganS, 0f)

  private def begin(world: Int): Unit =
    starts.draw(SplitMix64.seedOf(seeds(world), episodes(world)))
    episodes(world) += 1
    beganS(world) = worlds.scoredAtS
    for agent <- 0 until agents do startM(agent * count + world) = starts.distanceM(vehicles(agent))
    eachBelow(starts.northM.length): vehicle =>
      import starts.{eastM, headingRad, northM}
      worlds.restart(world, vehicle, northM(vehicle), eastM(vehicle), headingRad(vehicle))
    worlds.forgetScores(world)

  private def clear(world: Int): Unit =
    for agent <- 0 until agents do into.begun(agent, numberOf(world), startM(agent * count + world))
    hide(world)

  /** Clears the observations of an episode that has ended, for learners that are not due. */
  private def hide(world: Int): Unit =
    for agent <- 0 until agents if !worlds.isDue(agent); field <- 0 until fields do
      into.observations.put((agent * fields + field) * into.count + numberOf(world), 0f): Unit

  /** Writes the last observations of all learners, also of those that are not due. */
  private def showFinals(): Unit =
    show(into.finals)
    for agent <- 0 until agents if !worlds.isDue(agent); field <- 0 until fields do
      val of = agent * fields + field
      into.read(into.observations, of, first, stride, row, count)
      into.write(into.finals, of, first, stride, row, 0, count)

  /** Writes the observations of the learners that are due; the others' stay unchanged. */
  private def show(to: FloatBuffer): Unit =
    eachBelow(agents): agent =>
      val isDue = worlds.isDue(agent)
      if isDue != wasDue(agent) then
        wasDue(agent) = isDue
        into.due(agent, first, stride, count, isDue)
      if isDue then
        worlds.observe(agent, seen)
        eachBelow(fields): field =>
          into.write(to, agent * fields + field, first, stride, seen, field * Most, count)

  def close(): Unit = worlds.close()

private object EnvironmentGroup:
  val CaptureReward = 10f

  /** Tolerance for comparing times of scores, which are 32-bit floats, s. */
  val Tolerance = 1e-4f
