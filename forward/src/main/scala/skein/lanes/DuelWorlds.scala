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

  /** Whether efforts are asked for. They cost a tenth of a flight: how far a direction is from the one before
    * takes an arccosine.
    */
  def withEfforts: Boolean = true

  /** [[WorldRandom.key]] of the world: decides all delays. Worlds of one key and one link meet the same
    * delays.
    */
  def key(world: Int): Int
  def link(world: Int): Delays
  def pursuer(world: Int): Policy
  def evader(world: Int): Policy

/** What each world came to; see [[DuelOutcome]] for the meanings. One number per world, in metres, seconds
  * and radians. Efforts are NaN where they were not [[DuelWorlds.withEfforts asked for]].
  *
  * @param flown how many worlds were flown: all, unless the call was cancelled. The others' smallest distance
  *   is 0, as are all their numbers.
  */
final class DuelOutcomes private[skein] (size: Int):
  val minDistanceM, meanDistanceM, meanLast10sM, captureS, pursuerEffortRad, evaderEffortRad: Array[Float] =
    Array.ofDim[Float](size)
  private var done = 0

  def flown: Int = done

  private[skein] def flown_=(worlds: Int): Unit = done = worlds

  private[skein] def set(world: Int, outcome: DuelOutcome, withEfforts: Boolean = true): Unit =
    minDistanceM(world) = outcome.minDistanceM.toFloat
    meanDistanceM(world) = outcome.meanDistanceM.toFloat
    meanLast10sM(world) = outcome.meanLast10sM.toFloat
    captureS(world) = outcome.captureS.toFloat
    setEfforts(world, withEfforts, outcome.pursuerEffortRad.toFloat, outcome.evaderEffortRad.toFloat)

  private[lanes] def setEfforts(world: Int, areAsked: Boolean, pursuerRad: Float, evaderRad: Float): Unit =
    pursuerEffortRad(world) = if areAsked then pursuerRad else Float.NaN
    evaderEffortRad(world) = if areAsked then evaderRad else Float.NaN
