package skein.policy

import skein.units.Vector3

/** Flies alternate left and right arcs of varying durations. The path depends neither on other vehicles nor
  * on the age of readings.
  *
  * @param turnRadps turn rate of the commanded velocity
  * @param leastS shortest duration of an arc
  * @param mostS longest duration of an arc
  * @param course selects the sequence of durations, like a seed; each value gives a different path
  */
final case class Weave(speedMps: Double, turnRadps: Double, leastS: Double, mostS: Double, course: Double = 0)
    extends Policy:

  type Memory = Weave.Arc
  def start: Weave.Arc = Weave.Arc(0, 0, 0)

  def choose(seen: Observation, arc: Weave.Arc): (Action, Weave.Arc) =
    val elapsed = seen.elapsed.toSeconds
    val left    = arc.leftS - elapsed
    val isOver  = left <= 0
    // The arc ends when its time has elapsed, not at the next decision, so that the path does not depend on
    // the period.
    val before  = if isOver then arc.leftS else elapsed
    val number  = if isOver then arc.number + 1 else arc.number
    val remains = if isOver then left + (leastS + (mostS - leastS) * drawn(number)) else left
    val heading =
      arc.headingRad + turnRadps * (side(arc.number) * before + side(number) * (elapsed - before))
    (Weave.level(seen, heading, speedMps), Weave.Arc(heading, remains, number))

  /** 1 for an arc to the right, which has an even number; else −1. */
  private def side(number: Double): Double = 1 - 2 * (number - 2 * math.floor(number / 2))

  /** A number from 0 to 1 for each arc. Multiples of the golden ratio spread evenly (Weyl's sequence) and
    * need only arithmetic, which SIMD can repeat.
    */
  private def drawn(number: Double): Double =
    val spread = 0.6180339887498949 * number + 0.7548776662466927 * course
    spread - math.floor(spread)

object Weave:
  /** @param leftS time left in the arc
    * @param number the arc's number, from 1; 0 before the first decision
    */
  final case class Arc(headingRad: Double, leftS: Double, number: Double)

  /** A velocity along a heading that climbs or sinks to the altitude of the start, at 1 m/s per metre and at
    * most 2 m/s. AirSim's vehicle follows it three times faster than a heading at an altitude.
    */
  private[policy] def level(seen: Observation, headingRad: Double, speedMps: Double): Action =
    Action.Velocity(Vector3(
      speedMps * StrictMath.cos(headingRad),
      speedMps * StrictMath.sin(headingRad),
      (seen.startDown.value - seen.downM(seen.self)).max(-2.0).min(2.0)
    ))
