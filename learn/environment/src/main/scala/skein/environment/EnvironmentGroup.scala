package skein.environment

import java.nio.FloatBuffer
import skein.lanes.{LearnerPolicy, LearnerWorlds}
import skein.signal.SplitMix64

/** Environments that run side by side over one link: delays and losses of messages are equal in all of them.
  * Mutable; one thread at a time.
  *
  * They begin a ''run'' together, which lasts as long as an episode. Where an episode ends earlier, by a
  * capture, the next begins immediately in the current run, and lasts until the run's end; worlds that cannot
  * restart alone begin a new run.
  *
  * @param learning the learners' vehicles
  * @param first of the batch's environments; the others follow by `stride`
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
  import LearnerPolicy.Fields
  import LearnerWorlds.Most

  private val settings   = side.settings
  private val vehicles   = learning.toArray
  private val agents     = vehicles.length
  private val turns      = vehicles.map(side.mostTurn(_)._2)
  private val gains      = vehicles.map(CaptureReward * side.captureSign(_))
  private val weights    = vehicles.indices.map(side.weights(learning, _)).toArray
  private val starts     = Starts(side)
  private val seeds      = Array.ofDim[Long](count)
  private val episodes   = Array.ofDim[Long](count)
  private val isDone     = Array.ofDim[Boolean](count)

  /** When each world's episode began, since the run's start, s. */
  private val beganS = Array.ofDim[Float](count)
  private val seen   = Array.ofDim[Float](Fields * Most)
  private val startM = Array.ofDim[Float](agents * count)
  private var runs   = 0L
  private var isOver = true

  /** Whether the run ended before its time. */
  private var isEarly = false

  /** Whether no decision has been made in this run. */
  private var isFirst = true

  private def numberOf(world: Int) = first + world * stride

  /** Resets every environment.
    *
    * @param newSeeds of the whole batch; a negative one continues the environment's own sequence
    */
  def reset(newSeeds: Array[Long]): Unit =
    for world <- 0 until count do seed(world, newSeeds(numberOf(world)))
    if newSeeds(first) >= 0 then runs = 0
    startRun()
    for world <- 0 until count do clear(world)
    show(into.observations)

  /** Resets the environments of the mask, with their seeds. */
  def reset(newSeeds: Array[Long], mask: Array[Boolean]): Unit =
    val chosen = (0 until count).filter(world => mask(numberOf(world)))
    for world <- chosen do seed(world, newSeeds(numberOf(world)))
    if chosen.nonEmpty then
      val others = isDone.clone
      if isOver || !worlds.restartAlone then startRun() else chosen.foreach(begin)
      System.arraycopy(others, 0, isDone, 0, count)
      for world <- chosen do
        isDone(world) = false
        clear(world)
      show(into.observations)

  private def seed(world: Int, seed: Long): Unit =
    if seed >= 0 then
      seeds(world) = seed
      episodes(world) = 0

  /** An environment whose action is not finite, or −1. */
  def misfit(): Int =
    var world = 0
    while world < count do
      var agent = 0
      while agent < agents do
        if !(Math.abs(into.action(agent, numberOf(world))) <= Float.MaxValue) then return numberOf(world)
        agent += 1
      world += 1
    -1

  /** An environment that has ended and was not reset, or −1. */
  def ended: Int =
    val world = if autoreset == Autoreset.Disabled then isDone.indexOf(true) else -1
    if world < 0 then -1 else numberOf(world)

  def step(): Unit =
    if isOver then nextRun()
    else
      var agent = 0
      while agent < agents do
        if worlds.isDue(agent) then
          var world = 0
          while world < count do
            val share = math.max(-1f, math.min(1f, into.action(agent, numberOf(world))))
            worlds.tell(agent, world, share * turns(agent))
            world += 1
        agent += 1
      worlds.decide()
      // Scores before the first decision count for the first step.
      if !isFirst then worlds.forgetScores()
      isFirst = false
      val goesOn = worlds.flyOn()
      val isLast = worlds.scoredAtS + Tolerance >= settings.episodeS
      isOver = !goesOn || isLast
      isEarly = !goesOn && !isLast
      judge()

  /** Computes rewards, and which episodes have ended. */
  private def judge(): Unit =
    var world = 0
    var again = false
    while world < count do
      val number    = numberOf(world)
      val wasDone   = isDone(world)
      val isCapture = judge(world, number)
      into.time(number, worlds.scoredAtS - beganS(world))
      if wasDone then
        // Its action was ignored; it shows its next episode's first observation.
        isDone(world) = false
        begin(world)
        clear(world)
      else
        into.terminated(number, isCapture || isEarly)
        into.truncated(number, isOver && !isCapture && !isEarly)
        isDone(world) = isCapture || isOver
      again |= isDone(world)
      world += 1
    autoreset match
      case Autoreset.SameStep if again =>
        show(into.finals)
        restartDone()
        show(into.observations)
      case Autoreset.NextStep if again && !worlds.restartAlone =>
        isOver = true
        show(into.observations)
      case _ => show(into.observations)

  /** Writes the rewards and distances of one world's learners; returns whether one captured, or was. */
  private def judge(world: Int, number: Int): Boolean =
    var isCapture = false
    var agent     = 0
    while agent < agents do
      val distanceM = worlds.soFar(2 * agent, world)
      if !distanceM.isNaN then into.distance(agent, number, distanceM)
      val isNear = settings.captureRadiusM > 0 && worlds.soFar(2 * agent + 1, world) <= settings.captureRadiusM
      var cost   = 0f
      var term   = 0
      while term < weights(agent).length do
        if weights(agent)(term) != 0 then cost += weights(agent)(term) * worlds.soFar(2 * agents + term, world)
        term += 1
      into.reward(agent, number, (if isNear then gains(agent) else 0) - cost / EnvironmentSettings.RewardM)
      isCapture |= isNear
      agent += 1
    isCapture

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
        "nothing is decided in an episode: are the answers later than the time-out?"
      )
    java.util.Arrays.fill(beganS, 0f)

  private def begin(world: Int): Unit =
    starts.draw(SplitMix64.seedOf(seeds(world), episodes(world)))
    episodes(world) += 1
    beganS(world) = worlds.scoredAtS
    for agent <- 0 until agents do startM(agent * count + world) = starts.distanceM(vehicles(agent))
    var vehicle = 0
    while vehicle < starts.northM.length do
      import starts.{eastM, headingRad, northM}
      worlds.restart(world, vehicle, northM(vehicle), eastM(vehicle), headingRad(vehicle))
      vehicle += 1

  private def clear(world: Int): Unit =
    for agent <- 0 until agents do into.begun(agent, numberOf(world), startM(agent * count + world))

  /** Writes the observations of the learners that are due; the others' stay unchanged. */
  private def show(to: FloatBuffer): Unit =
    var agent = 0
    while agent < agents do
      val isDue = worlds.isDue(agent)
      var world = 0
      while world < count do
        into.due(agent, numberOf(world), isDue)
        world += 1
      if isDue then
        worlds.observe(agent, seen)
        var field = 0
        while field < Fields do
          val at = (agent * Fields + field) * into.count + first
          if stride == 1 then to.put(at, seen, field * Most, count): Unit
          else
            world = 0
            while world < count do
              to.put(at + world * stride, seen(field * Most + world)): Unit
              world += 1
          field += 1
      agent += 1

  def close(): Unit = worlds.close()

private object EnvironmentGroup:
  val CaptureReward = 10f

  /** Tolerance for comparing times of scores, which are 32-bit floats, s. */
  val Tolerance = 1e-4f
