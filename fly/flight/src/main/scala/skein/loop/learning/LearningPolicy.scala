package skein.loop.learning

import skein.policy.*
import skein.signal.{NormalQuantile, SplitMix64}
import skein.units.Span

/** A network whose parameters change during a flight, between two decisions and never within one. It
  * explores: normal noise is added to its outputs, drawn from the seed and the decision's number. A
  * repetition with the recorded versions gives equal decisions.
  *
  * @param first decides until the first update
  * @param version makes a policy of other parameters
  * @param explore the noise's deviation, as a fraction of the largest action
  * @param period time between two decisions
  * @param note called with all updates, and the number of the next decision
  */
final class LearningPolicy(
    first: LearnedPolicy,
    version: Vector[Double] => LearnedPolicy,
    explore: Double,
    seed: Long,
    lessons: Lessons,
    period: Span,
    note: (Long, LearnerUpdate) => Unit
) extends Policy:
  import LearningPolicy.*

  @volatile private var newest = first

  /** The last decision whose transition was given: a late call and the next have one number. */
  @volatile private var taught = -1L

  type Memory = Option[Before]

  def start: Memory = None

  override def isAgainstOne: Boolean = true

  override def isPlanar: Boolean = !first.space.climbs

  /** The newest policy, without exploration. */
  override def guessed(draw: Int => Double): Policy = newest

  def choose(seen: Observation, memory: Memory): (Action, Memory) =
    for news <- lessons.news(seen.decisions) do
      note(seen.decisions, news)
      news.parameters.foreach(parameters => newest = version(parameters))
    val observed = first.space.observe(seen)
    val numbers  = observed.toVector
    memory match
      // After a decision that something else made instead, or a pause, the effect of its own is unknown.
      case Some(Before(decision, usual, before, shares))
          if decision + 1 == seen.decisions && decision > taught && seen.elapsed <= usual.max(period) * 2 =>
        taught = decision
        lessons.flown(Transition(before, shares, numbers, distanceM(seen)))
      case _ => ()
    val random = SplitMix64(SplitMix64.seedOf(seed, seen.decisions))
    val policy = newest
    val shares = policy.shares(observed).map(share => (share + noise(random)).max(-1.0).min(1.0))
    (policy.act(seen, shares), Some(Before(seen.decisions, seen.elapsed, numbers, shares.toVector)))

  private def noise(random: SplitMix64) =
    if explore == 0 then 0.0 else explore * NormalQuantile(random.nextDouble().max(Least))

  private def distanceM(seen: Observation) =
    val toOpponent = seen.vehicles(seen.opponent).kinematics.positionNed - seen.own.kinematics.positionNed
    val level      = StrictMath.hypot(toOpponent.x, toOpponent.y)
    if first.space.climbs then StrictMath.hypot(level, toOpponent.z) else level

object LearningPolicy:
  private val Least = 1e-12

  /** The last decision: the time since the one before it, its observation, and its action. */
  final case class Before(decision: Long, elapsed: Span, seen: Vector[Double], shares: Vector[Double])
