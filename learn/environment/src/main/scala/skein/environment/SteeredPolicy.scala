package skein.environment

import skein.policy.HeadingPolicy

/** Turns at a rate that is set from outside before each decision.
  *
  * @param rateRadPerS to the right
  */
private[environment] final case class SteeredPolicy(rateRadPerS: Double) extends HeadingPolicy:
  def heading(
      dxM: Double,
      dyM: Double,
      dvxMps: Double,
      dvyMps: Double,
      ownHeadingRad: Double,
      opponentHeadingRad: Double,
      elapsedS: Double
  ): Double = ownHeadingRad + rateRadPerS * elapsedS

/** Turns in one instant by an angle that is set from outside before each decision.
  *
  * @param turnRad to the right
  */
private[environment] final case class Turned(turnRad: Double) extends HeadingPolicy:
  def heading(
      dxM: Double,
      dyM: Double,
      dvxMps: Double,
      dvyMps: Double,
      ownHeadingRad: Double,
      opponentHeadingRad: Double,
      elapsedS: Double
  ): Double = ownHeadingRad + turnRad
