package skein.learn

import java.nio.ByteBuffer
import skein.environment.{Autoreset, EnvironmentBatch, EnvironmentBuffers, EnvironmentSettings}
import skein.policy.{LearnedPolicy, LearnerSpace, PolicyFamily, Role}
import skein.scenario.Scenarios
import skein.settings.PolicyFile
import skein.signal.SplitMix64
import skein.units.eachBelow

/** A side of the duel or of another scenario as a learning task, under the loop's timing. Observations are
  * scaled as [[LearnerSpace]] states, and rewards so that a policy's discounted return is about 1. If a side
  * has several vehicles, one per environment learns; the others use the policy from before the round.
  *
  * @param seed seed of the initial positions and of the messages' delays
  */
final class SideTask private (
    batch: EnvironmentBatch,
    buffers: EnvironmentBuffers,
    bounds: Vector[Double],
    seed: Long
) extends Task,
      AutoCloseable:
  import buffers.space
  private val scales = space.scales.map(_.toFloat).toArray

  val count: Int        = batch.count
  val observations: Int = space.inputs
  val actions: Int      = space.outputs

  val seen, reached: Array[Float]       = Array.ofDim(count * observations)
  val rewards: Array[Float]             = Array.ofDim(count)
  val terminated, ended: Array[Boolean] = Array.ofDim(count)

  def begin(round: Long, actor: Network): Unit =
    val hidden = actor.widths.tail.init
    val family = PolicyFamily.learned(LearnedPolicy.shape(hidden, space))
    batch.fly(family.policy(SideTask.parameters(actor) ++ bounds))
    val ofRound = SplitMix64.seedOf(seed, round)
    batch.reset(Array.tabulate(count)(number => SplitMix64.seedOf(ofRound, number) & Long.MaxValue))
    copy(buffers.observations, seen)

  def step(actions: Array[Float]): Unit =
    for component <- 0 until this.actions; number <- 0 until count do
      buffers.actions.put(component * count + number, actions(number * this.actions + component)): Unit
    batch.step()
    copy(buffers.observations, seen)
    System.arraycopy(seen, 0, reached, 0, seen.length)
    for number <- 0 until count do
      rewards(number) = buffers.rewards.get(number) * SideTask.RewardScale
      terminated(number) = buffers.terminations.get(number) != 0
      ended(number) = terminated(number) || buffers.truncations.get(number) != 0
      if ended(number) then copyRow(buffers.finals, reached, number)

  def close(): Unit = batch.close()

  private def copy(from: java.nio.FloatBuffer, into: Array[Float]): Unit =
    for number <- 0 until count do copyRow(from, into, number)

  private def copyRow(from: java.nio.FloatBuffer, into: Array[Float], number: Int): Unit =
    eachBelow(observations): field =>
      into(number * observations + field) = from.get(field * count + number) / scales(field)

object SideTask:
  private val RewardScale = 0.1f

  /** The reward of a metre of distance, which environments give once a period. */
  private[learn] val RewardPerM: Double = RewardScale / EnvironmentSettings.RewardM

  /** @param opponent policy of the other role; None: the one in the settings
    * @return Left says what was expected and what was given
    */
  def of(
      settings: EnvironmentSettings,
      opponent: Option[PolicyFile],
      count: Int,
      seed: Long
  )(using Scenarios): Either[String, SideTask] =
    if settings.learners == "both" then Left("learners: expected pursuer or evader, got 'both'")
    else if count < 1 || count > EnvironmentBatch.Most then
      Left(s"environments: expected 1 to ${EnvironmentBatch.Most}, got $count")
    else
      val block = ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(1, count, settings.space))
      EnvironmentBatch
        .of(settings, count, Autoreset.SameStep, block, opponent)
        .map: batch =>
          SideTask(batch, EnvironmentBuffers(block, 1, count, settings.space), bounds(settings), seed)

  private def bounds(settings: EnvironmentSettings) =
    val (rate, angle) =
      settings.mostTurn(if settings.learners == "pursuer" then Role.Pursuer else Role.Evader)
    Vector(rate, angle) ++ Option.when(settings.space.climbs)(settings.climbMps)

  /** The weights of a trained policy from an actor, whose first outputs are the action: neuron by neuron. */
  def parameters(actor: Network): Vector[Double] =
    val spaces = Seq(LearnerSpace.Level, LearnerSpace.Climbing)
    val space  = spaces
      .find(_.inputs == actor.inputs)
      .getOrElse:
        throw IllegalArgumentException(
          s"expected ${spaces.map(_.inputs).mkString(" or ")} inputs, got ${actor.inputs}"
        )
    val widths = actor.widths.init :+ space.outputs
    for
      layer  <- (0 until actor.layers).toVector
      neuron <- 0 until widths(layer + 1)
      outs    = actor.widths(layer + 1)
      weights =
        (0 until widths(layer)).map(input => actor.parameters(actor.weightsAt(layer) + input * outs + neuron))
      weight <- weights :+ actor.parameters(actor.biasesAt(layer) + neuron)
    yield weight.toDouble

  /** The observations that are ages: a learner that ignores ages does not use them. */
  val times: Range = 6 until 9
