package skein.environment

import java.nio.FloatBuffer
import skein.lanes.LearnerDuels.FIELDS
import skein.policy.{Policy, Role}
import skein.signal.SplitMix64

/** Environments of a scenario, each with its own time and link. In environment number n the learner is member
  * n of its role, modulo their number.
  */
private final class ScenarioGroup(
    side: ScenarioSide,
    autoreset: Autoreset,
    count: Int,
    into: EnvironmentBuffers
) extends EnvironmentGroup:
  import EnvironmentGroup.CaptureReward

  private val settings = side.settings
  private val flights  =
    Array.tabulate(count)(number => LearnerRollout(side, side.members(number % side.members.size)))
  private val seeds    = Array.ofDim[Long](count)
  private val episodes = Array.ofDim[Long](count)
  private val isDone   = Array.ofDim[Boolean](count)
  private var beside   = Option.empty[Policy]

  /** What the learner's like fly from their next episodes on. */
  def fly(policy: Policy): Unit = beside = Some(policy)

  def reset(newSeeds: Array[Long]): Unit = reset(newSeeds, Array.fill(count)(true))

  def reset(newSeeds: Array[Long], mask: Array[Boolean]): Unit =
    val chosen = (0 until count).filter(mask(_))
    for number <- chosen do
      if newSeeds(number) >= 0 then
        seeds(number) = newSeeds(number)
        episodes(number) = 0
    beginAll(chosen)
    for number <- chosen do clear(number)

  def misfit(): Int = into.misfit(0, count)

  def ended: Int = if autoreset == Autoreset.Disabled then isDone.indexOf(true) else -1

  def step(): Unit =
    val begins = isDone.clone
    for number <- 0 until count do
      if begins(number) then prepare(number)
      else flights(number).share = math.max(-1.0, math.min(1.0, into.action(0, number).toDouble))
      flights(number).goOn()
    for number <- 0 until count do flights(number).await()
    for number <- 0 until count do
      if begins(number) then
        clear(number)
        show(number, into.observations)
      else judge(number)
    if autoreset == Autoreset.SameStep then
      val ended = (0 until count).filter(isDone(_))
      for number <- ended do show(number, into.finals)
      beginAll(ended)

  /** Computes an environment's reward, and whether it has ended. */
  private def judge(number: Int): Unit =
    val flight   = flights(number)
    val captured = settings.captureRadiusM > 0 && flight.leastM <= settings.captureRadiusM
    val gained = if !captured then 0f else if side.role == Role.Pursuer then CaptureReward else -CaptureReward
    into.reward(0, number, gained - (flight.loss / EnvironmentSettings.RewardM).toFloat)
    into.distance(number, flight.distanceM.toFloat)
    into.time(number, flight.scoredAtS.toFloat)
    into.terminated(number, captured)
    into.truncated(number, flight.isOver && !captured)
    isDone(number) = captured || flight.isOver
    show(number, into.observations)

  private def prepare(number: Int): Unit =
    flights(number).begin(SplitMix64.seedOf(seeds(number), episodes(number)), beside)
    episodes(number) += 1
    isDone(number) = false

  private def beginAll(chosen: Seq[Int]): Unit =
    for number <- chosen do
      prepare(number)
      flights(number).goOn()
    for number <- chosen do
      flights(number).await()
      show(number, into.observations)

  private def clear(number: Int): Unit = into.begun(number, flights(number).distanceM.toFloat)

  private def show(number: Int, to: FloatBuffer): Unit =
    into.due(0, number, true)
    for field <- 0 until FIELDS do to.put(field * into.count + number, flights(number).seen(field)): Unit

  override def close(): Unit = flights.foreach(_.close())
