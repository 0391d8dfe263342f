package skein.environment

import skein.policy.{HeadingPolicy, PlanarObservation}

/** Turns at a rate that is set from outside before each decision.
  *
  * @param rateRadPerS to the right
  */
private[environment] final case class SteeredPolicy(rateRadPerS: Double) extends HeadingPolicy.Memoryless:
  def heading(seen: PlanarObservation): Double =
    import seen.*
    ownHeadingRad + rateRadPerS * elapsedS

/** Turns in one instant by an angle that is set from outside before each decision.
  *
  * @param turnRad to the right
  */
private[environment] final case class Turned(turnRad: Double) extends HeadingPolicy.Memoryless:
  def heading(seen: PlanarObservation): Double =
    import seen.*
    ownHeadingRad + turnRad
