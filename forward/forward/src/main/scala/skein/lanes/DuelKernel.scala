package skein.lanes

import skein.forward.Rollout
import skein.lanes.policy.LanePolicy
import skein.lanes.score.{OfMoment, Scoreboard}
import skein.scenario.Reduction

/** Results of the worlds that a kernel of duels simulated last. Mutable.
  *
  * @param asked the numbers to compute
  */
private[lanes] abstract class DuelKernel(durationS: Double, periodS: Double, asked: Set[DuelNumber]):
  import DuelKernel.*

  private val judged = DuelKernel.judged(durationS, periodS, asked)
  private val place  = judged.map(_._1).zipWithIndex.toMap

  protected val scores: Scoreboard = Scoreboard.ofDistance(judged.map(_._2)*)

  /** Sets the distance up to which a capture counts, m. */
  protected def captureWithin(radiusM: Float): Unit =
    place.get(DuelNumber.Capture).foreach(scores.limit(_, radiusM))

  /** The sums of all changes of the commanded headings, by the shorter way, rad. */
  protected val pursuerEffortRad, evaderEffortRad: Array[Float] = Array.ofDim(WORLDS)

  /** One number of the result, for each world. */
  def apply(number: DuelNumber): Array[Float] = number match
    case DuelNumber.PursuerEffort => pursuerEffortRad
    case DuelNumber.EvaderEffort  => evaderEffortRad
    case _                        => scores.values(place(number))

  /** Copies the results of the first lanes' worlds. */
  def tell(worlds: Array[Int], count: Int, into: DuelOutcomes): Unit = for number <- asked do
    val (came, told) = (apply(number), into(number))
    for lane <- 0 until count do told(worlds(lane)) = came(lane)

private[lanes] object DuelKernel:
  /** Number of worlds simulated together. */
  val WORLDS: Int = LanePolicy.WORLDS

  /** The reductions of the vehicles' distance that the requested numbers need. */
  def judged(
      durationS: Double,
      periodS: Double,
      asked: Set[DuelNumber]
  ): Vector[(DuelNumber, (Reduction | OfMoment, Double))] =
    DuelNumber.values.toVector.filter(asked).flatMap: number =>
      (number match
        case DuelNumber.MinDistance  => Some(Reduction.Least -> 0.0)
        case DuelNumber.MeanDistance => Some(Reduction.Mean -> 0.0)
        case DuelNumber.MeanLast10s  => Some(Reduction.Mean -> Rollout.last10sFromS(durationS, periodS))
        case DuelNumber.Capture      => Some(OfMoment.FirstWithin(0) -> 0.0)
        case _                       => None
      ).map(number -> _)
