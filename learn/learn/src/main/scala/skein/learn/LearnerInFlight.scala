package skein.learn

import skein.loop.learning.{FlownLearner, Transition}
import skein.policy.{LearnerSpace, Role}
import skein.signal.SplitMix64

/** Continues learning from the transitions of one flight, with a replay learner. Rewards are those of
  * [[SideTask]]: the pursuer is rewarded for a small distance, the evader for a great one. Equal transitions
  * in equal lessons give equal weights.
  *
  * @param bounds maximum turns and vertical speed of its policies: the last parameters of a
  *   [[skein.policy.LearnedPolicy]]
  * @param updates number of updates per transition
  * @param transitionsPerVersion number of transitions after which the newest policy is used
  */
final class LearnerInFlight private (
    learner: OffPolicy,
    role: Role,
    space: LearnerSpace,
    bounds: Vector[Double],
    updates: Double,
    transitionsPerVersion: Int,
    seed: Long
) extends FlownLearner:
  private val scales  = space.scales.map(_.toFloat)
  private val random  = SplitMix64(seed)
  private var lessons = 0L
  private var learned = 0L
  private var due     = 0.0

  def learn(transitions: Vector[Transition]): Option[Vector[Double]] =
    lessons += 1
    learner.begin(SplitMix64.seedOf(seed, lessons) & Long.MaxValue)
    val versions = learned / transitionsPerVersion
    for transition <- transitions do
      val loss = (transition.distanceM * SideTask.RewardPerM).toFloat
      // A flight is one episode, and its end is a truncation.
      learner.replay.add(
        row(transition.seen),
        transition.shares.map(_.toFloat).toArray,
        row(transition.reached),
        Array(if role == Role.Pursuer then -loss else loss),
        Array(false)
      )
      learned += 1
      if learner.replay.size >= learner.batch.count then
        due += updates
        while due >= 1 do
          learner.replay.draw(learner.batch, random)
          learner.update()
          due -= 1
    Option.when(learned / transitionsPerVersion > versions)(SideTask.parameters(learner.actor) ++ bounds)

  private def row(numbers: Vector[Double]) =
    numbers.lazyZip(scales).map((number, scale) => number.toFloat / scale).toArray

object LearnerInFlight:
  /** Restores a stored learner.
    *
    * @param load fills it with the stored state, if there is one
    * @return the parameters of its policy, and the learner; Left says why it cannot learn in flight
    */
  def of(
      algorithm: Algorithm,
      settings: LearnerSettings,
      role: Role,
      space: LearnerSpace,
      bounds: Vector[Double],
      updates: Double,
      transitionsPerVersion: Int,
      seed: Long
  )(load: Learner => Either[String, Unit]): Either[String, (Vector[Double], LearnerInFlight)] =
    algorithm.learner(space.inputs, space.outputs, 1, settings, seed, BatchThreads(1)) match
      case learner: OffPolicy =>
        load(learner).map: _ =>
          (
            SideTask.parameters(learner.actor) ++ bounds,
            LearnerInFlight(learner, role, space, bounds, updates, transitionsPerVersion, seed)
          )
      case _ =>
        Left(
          s"${algorithm.label} learns from its newest steps alone, of many environments; expected sac or ddpg"
        )
