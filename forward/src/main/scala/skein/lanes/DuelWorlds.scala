package skein.lanes

import skein.forward.{Delays, DuelOutcome}
import skein.policy.Policy

/** The worlds of one call of [[DuelBatch]], by number from 0. Pure functions of the number, called from any
  * thread.
  *
  * Neighbours that share a link should return the same object: it is copied into the first-level cache once
  * for all of them. Otherwise the order is free.
  */
trait DuelWorlds:
  def size: Int

  /** Whether many worlds have the same key and the same link, as candidates that meet the same episodes do.
    * Then they fly together through one [[Timetable]], several times as fast.
    */
  def shareEpisodes: Boolean = false

  /** What worlds are judged by. Nothing else is computed. */
  def asked: Set[DuelNumber] = DuelNumber.all

  /** [[WorldRandom.key]] of the world: decides all delays. Worlds of one key and one link meet the same
    * delays.
    */
  def key(world: Int): Int
  def link(world: Int): Delays
  def pursuer(world: Int): Policy
  def evader(world: Int): Policy

/** What duels may be judged by; see [[DuelOutcome]] for the meanings. An effort costs a twentieth of a
  * flight: how far a direction is from the one before takes an arccosine.
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

/** What each world came to. One number per world, in metres, seconds and radians; NaN where it was not
  * [[DuelWorlds.asked asked for]].
  *
  * @param flown how many worlds were flown: all, unless the call was cancelled. The others' numbers are 0.
  */
final class DuelOutcomes private[skein] (size: Int, asked: Set[DuelNumber] = DuelNumber.all):
  private val came = DuelNumber.values.map(number => Array.fill(size)(if asked(number) then 0 else Float.NaN))

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
