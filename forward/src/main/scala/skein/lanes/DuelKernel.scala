package skein.lanes

import skein.forward.Rollout
import skein.scenario.Reduction

/** What kernels that fly duels tell of the worlds flown last. Mutable. */
private[lanes] abstract class DuelKernel(durationS: Double, periodS: Double):
  import DuelKernel.*

  protected val scores: Scoreboard = Scoreboard.ofDistance(
    (Reduction.Least, 0),
    (Reduction.Mean, 0),
    (Reduction.Mean, Rollout.last10sFromS(durationS, periodS)),
    (OfMoment.FirstWithin(0), 0)
  )

  /** A distance of at most this is a capture, m. */
  protected def captureWithin(radiusM: Float): Unit = scores.limit(Capture, radiusM)

  /** Distances, m: the smallest, the mean, and the mean of the last 10 s. */
  def minDistance: Array[Float]  = came(Min)
  def meanDistance: Array[Float] = came(Mean)
  def meanLast10s: Array[Float]  = came(Last10s)

  /** When the distance first was within the capture radius, s; infinite where it never was. */
  def captureS: Array[Float] = came(Capture)

  /** Tells what the world of a lane came to. */
  def tell(lane: Int, into: DuelOutcomes, world: Int, withEfforts: Boolean): Unit =
    into.minDistanceM(world) = scores.value(Min, lane)
    into.meanDistanceM(world) = scores.value(Mean, lane)
    into.meanLast10sM(world) = scores.value(Last10s, lane)
    into.captureS(world) = scores.value(Capture, lane)
    into.setEfforts(world, withEfforts, pursuerEffortRad(lane), evaderEffortRad(lane))

  private def came(number: Int) = Array.tabulate(WORLDS)(scores.value(number, _))

  /** The sums of all changes of the commanded headings, by the shorter way, rad. */
  val pursuerEffortRad, evaderEffortRad: Array[Float] = Array.ofDim(WORLDS)

private[lanes] object DuelKernel:
  /** Worlds flown together. */
  val WORLDS: Int = LanePolicy.WORLDS

  // By what is judged.
  private val Min     = 0
  private val Mean    = 1
  private val Last10s = 2
  private val Capture = 3
