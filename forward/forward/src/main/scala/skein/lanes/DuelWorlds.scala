package skein.lanes

import skein.forward.DuelOutcome
import skein.policy.HeadingPolicy

/** The worlds of one call of [[DuelBatch]]: two policies and a link each. */
trait DuelWorlds extends Worlds:
  /** The numbers to compute for each world. No others are computed. */
  def asked: Set[DuelNumber] = DuelNumber.all

  def pursuer(world: Int): HeadingPolicy
  def evader(world: Int): HeadingPolicy

/** The numbers by which duels can be judged; see [[DuelOutcome]] for their meaning. An effort costs a
  * twentieth of a flight: the angle between successive directions takes an arccosine.
  */
enum DuelNumber(private[lanes] val of: DuelOutcome => Double):
  case MinDistance   extends DuelNumber(_.minDistanceM)
  case MeanDistance  extends DuelNumber(_.meanDistanceM)
  case MeanLast10s   extends DuelNumber(_.meanLast10sM)
  case Capture       extends DuelNumber(_.captureS)
  case PursuerEffort extends DuelNumber(_.pursuerEffortRad)
  case EvaderEffort  extends DuelNumber(_.evaderEffortRad)

object DuelNumber:
  val all: Set[DuelNumber] = values.toSet

/** The results of each world. One number per world, in metres, seconds and radians; NaN where it was not
  * [[DuelWorlds.asked requested]].
  *
  * @param flown number of simulated worlds: all, unless the call was cancelled. The others' numbers are 0.
  */
final class DuelOutcomes private[skein] (size: Int, asked: Set[DuelNumber] = DuelNumber.all):
  private val came = DuelNumber.values.map: number =>
    val numbers = Array.ofDim[Float](size)
    if !asked(number) then java.util.Arrays.fill(numbers, Float.NaN)
    numbers

  def apply(number: DuelNumber): Array[Float] = came(number.ordinal)

  def minDistanceM: Array[Float]     = this(DuelNumber.MinDistance)
  def meanDistanceM: Array[Float]    = this(DuelNumber.MeanDistance)
  def meanLast10sM: Array[Float]     = this(DuelNumber.MeanLast10s)
  def captureS: Array[Float]         = this(DuelNumber.Capture)
  def pursuerEffortRad: Array[Float] = this(DuelNumber.PursuerEffort)
  def evaderEffortRad: Array[Float]  = this(DuelNumber.EvaderEffort)

  private var done = 0

  def flown: Int = done

  private[skein] def flown_=(worlds: Int): Unit = done = worlds

  private[skein] def set(world: Int, outcome: DuelOutcome): Unit =
    for number <- asked do this(number)(world) = number.of(outcome).toFloat
