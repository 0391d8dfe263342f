package skein.forward

import skein.policy.Role

/** The outcome of an episode. Distances are horizontal, taken once a period.
  *
  * @param captureS time when the distance first was at most the capture radius; infinite if never
  * @param pursuerEffortRad control effort: the sum of all changes of the commanded heading, by the shorter
  *   way
  * @param evaderEffortRad control effort of the evader
  * @param decisions number of decisions of both agents
  * @param skipped number of views that a newer one replaced before the agent decided on them
  */
final case class EpisodeOutcome(
    minDistanceM: Double,
    minDistanceAtS: Double,
    meanDistanceM: Double,
    meanLast10sM: Double,
    captureS: Double,
    pursuerEffortRad: Double,
    evaderEffortRad: Double,
    decisions: Int,
    skipped: Int
)

/** The outcome of an episode for one evader. Distances are to the nearest pursuer, once a period.
  *
  * @param captureS time when the distance first was at most the capture radius; infinite if never
  */
final case class EvaderOutcome(
    minDistanceM: Double,
    minDistanceAtS: Double,
    meanDistanceM: Double,
    meanLast10sM: Double,
    captureS: Double
)

/** Scores an episode: the minimum distance of any evader, the mean over the evaders of each mean, and the
  * time of the last capture; distances are to the nearest pursuer, efforts are summed over a side. In a team
  * without sides all vehicles count, with the distance to the nearest other, and the effort is that of the
  * evaders. One per episode.
  *
  * @param captureRadiusM distance at which an evader is captured
  */
class Scoring(engagement: Engagement, timing: LoopTiming, captureRadiusM: Double = 0.0) extends LoopObserver:
  private val vehicles = engagement.roles.indices.toVector
  private val evaders  = vehicles.filter(engagement.roles(_) == Role.Evader)
  private val pursuers = vehicles.filter(engagement.roles(_) == Role.Pursuer)
  private val judged   = if evaders.nonEmpty then evaders else vehicles
  private val last10s  = Rollout.last10sFromS(engagement.durationS, timing.periodS)
  private val tallies  = judged.map(_ => Score(captureRadiusM, last10s))
  private val places   = Array.ofDim[(Double, Double)](vehicles.size)

  private def against(one: Int) = if evaders.nonEmpty then pursuers else vehicles.filter(_ != one)

  override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
    places(vehicle) = (x, y)
    if vehicle == vehicles.last then
      for (evader, tally) <- judged.zip(tallies) do
        val (atX, atY) = places(evader)
        val distances  =
          against(evader).map(other => StrictMath.hypot(atX - places(other)._1, atY - places(other)._2))
        tally.add(timeS, distances.minOption.getOrElse(Double.PositiveInfinity))

  /** @param flown the rollout whose last episode this observed */
  def outcome(flown: Rollout): EpisodeOutcome =
    import flown.controllers
    val each    = evaderOutcomes
    val nearest = each.minBy(_.minDistanceM)
    EpisodeOutcome(
      nearest.minDistanceM,
      nearest.minDistanceAtS,
      each.map(_.meanDistanceM).sum / each.size,
      each.map(_.meanLast10sM).sum / each.size,
      each.map(_.captureS).max,
      pursuers.map(controllers(_).effortRad).sum,
      judged.map(controllers(_).effortRad).sum,
      controllers.map(_.decisions).sum,
      controllers.map(_.skipped).sum
    )

  /** One for each evader in the engagement's order; in a team without sides, one for each vehicle. */
  def evaderOutcomes: Vector[EvaderOutcome] = tallies.map(_.outcome)

/** A [[Rollout]] with the outcome of each episode. */
final class ScoredRollout(
    engagement: Engagement,
    timing: LoopTiming,
    link: Delays,
    model: VelocityResponse
):
  private val rollout = Rollout(engagement, timing, link, model)
  private var scoring = Scoring(engagement, timing)

  def fly(worldKey: Int, captureRadiusM: Double = 0.0): EpisodeOutcome =
    scoring = Scoring(engagement, timing, captureRadiusM)
    rollout.fly(worldKey, scoring)
    scoring.outcome(rollout)

  /** The outcomes of the last episode. */
  def evaderOutcomes: Vector[EvaderOutcome] = scoring.evaderOutcomes

/** Accumulates the distances of an episode into its outcome. */
private final class Score(captureRadiusM: Double = 0.0, last10sFromS: Double):
  private var count        = 0
  private var least        = Double.PositiveInfinity
  private var leastAt      = 0.0
  private var sum, lastSum = 0.0
  private var lastCount    = 0
  private var captureS     = Double.PositiveInfinity

  def add(timeS: Double, distanceM: Double): Unit =
    count += 1
    sum += distanceM
    if distanceM < least then
      least = distanceM; leastAt = timeS
    if distanceM <= captureRadiusM && captureS.isInfinite then captureS = timeS
    if timeS > last10sFromS - 1e-6 then
      lastSum += distanceM
      lastCount += 1

  def outcome: EvaderOutcome = EvaderOutcome(least, leastAt, sum / count, lastSum / lastCount, captureS)
