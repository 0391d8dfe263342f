package skein.loop.learning

import skein.policy.*
import skein.signal.{NormalQuantile, SplitMix64}

/** A network whose parameters change during a flight, between two decisions and never within one. It
  * explores: normal noise is added to its output, drawn from the seed and the decision's number. A repetition
  * with the recorded versions gives equal decisions.
  *
  * @param first decides until the first update
  * @param version makes a policy of other parameters
  * @param explore the noise's deviation, as a share of the largest turn
  * @param note called with all updates, and the number of the next decision
  */
final class LearningPolicy(
    first: LearnedPolicy,
    version: Vector[Double] => LearnedPolicy,
    explore: Double,
    seed: Long,
    lessons: Lessons,
    note: (Long, LearnerUpdate) => Unit
) extends Policy:
  import LearningPolicy.*

  @volatile private var newest = first

  type Memory = Option[Before]

  def start: Memory = None

  override def isAgainstOne: Boolean = true

  override def isPlanar: Boolean = true

  /** The newest policy, without exploration. */
  override def guessed(draw: Int => Double): Policy = newest

  def choose(seen: Observation, memory: Memory): (Action, Memory) =
    for news <- lessons.news(seen.decisions) do
      note(seen.decisions, news)
      news.parameters.foreach(parameters => newest = version(parameters))
    val observed = PlanarObservation.of(seen)
    val numbers  = observed.fromOwnHeading.toVector
    memory match
      // After a decision that something else made instead, the effect of its own decision is unknown.
      case Some(Before(decision, before, share)) if decision + 1 == seen.decisions =>
        lessons.flown(Transition(before, share, numbers, StrictMath.hypot(observed.dxM, observed.dyM)))
      case _ => ()
    val policy = newest
    val share  = (policy.share(observed) + explore * normal(seen.decisions)).max(-1.0).min(1.0)
    val turn   = share * (policy.turnRateRadPerS * observed.elapsedS + policy.turnRad)
    val next   = Before(seen.decisions, numbers, share)
    (seen.along(observed.ownHeadingRad + turn, seen.cruise.value), Some(next))

  private def normal(decision: Long) =
    if explore == 0 then 0.0
    else NormalQuantile(SplitMix64(SplitMix64.seedOf(seed, decision)).nextDouble().max(Least))

object LearningPolicy:
  private val Least = 1e-12

  /** The last decision: its observation, and its share of the largest turn. */
  final case class Before(decision: Long, seen: Vector[Double], share: Double)
