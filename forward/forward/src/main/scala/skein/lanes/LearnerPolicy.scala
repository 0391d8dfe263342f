package skein.lanes

import skein.policy.{HeadingPolicy, PlanarObservation}

/** Turns by an amount in its memory, which a caller sets before each decision. Its next memory contains its
  * observation. So a learner's vehicle decides and observes by the code that other policies use.
  *
  * @param byRate whether the turn is a rate, rad/s; otherwise it is an angle, rad
  */
final case class LearnerPolicy(byRate: Boolean) extends HeadingPolicy:
  type Memory = LearnerPolicy.Memory

  def start: Memory = LearnerPolicy.start

  def decide(seen: PlanarObservation, memory: Memory): (Double, Memory) =
    (
      LearnerPolicy.headingRad(seen, memory.turn, byRate),
      LearnerPolicy.memory(memory.turn, seen.fromOwnHeading)
    )

object LearnerPolicy:
  /** Number of components of an observation, see [[PlanarObservation.fromOwnHeading]]. */
  final val Fields = 9

  /** The turn to make, to the right, and the components of [[PlanarObservation.fromOwnHeading]]. */
  final case class Memory(
      turn: Double,
      aheadM: Double,
      rightM: Double,
      aheadMps: Double,
      rightMps: Double,
      cos: Double,
      sin: Double,
      elapsedS: Double,
      ownAgeS: Double,
      opponentAgeS: Double
  )

  /** The heading after a turn to the right, by a rate since the last decision or by an angle, rad. */
  def headingRad(seen: PlanarObservation, turn: Double, byRate: Boolean): Double =
    seen.ownHeadingRad + (if byRate then turn * seen.elapsedS else turn)

  private val start = Memory(0, 0, 0, 0, 0, 1, 0, 0, 0, 0)

  private def memory(told: Double, seen: Array[Double]) =
    Memory(told, seen(0), seen(1), seen(2), seen(3), seen(4), seen(5), seen(6), seen(7), seen(8))
