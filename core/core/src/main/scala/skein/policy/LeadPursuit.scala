package skein.policy

/** Heads for the point where it would meet an opponent on a straight course: with γ = opponent's over own
  * speed and α the angle from the line of sight to the opponent's heading, the law of sines gives the lead
  * angle asin(γ sin α) ahead of the line of sight. The lead angle is at most a right angle, also if the
  * opponent cannot be met.
  *
  * The opponent's course is the heading last commanded to it, which a controller of both vehicles knows.
  *
  * @param speedRatio γ; the paper's is 0.5
  * @param lead share of the computed lead angle: 1 meets the opponent, 0 is pure pursuit
  * @param turnRateRadPerS maximum turn rate
  */
final case class LeadPursuit(speedRatio: Double = 0.5, lead: Double = 1.0, turnRateRadPerS: Double = 1.0)
    extends HeadingPolicy.Memoryless:
  require(speedRatio >= 0, s"the ratio of speeds must not be negative, got $speedRatio")
  require(turnRateRadPerS > 0, s"the turn rate must be positive, got $turnRateRadPerS rad/s")

  def heading(seen: PlanarObservation): Double =
    import seen.*
    val sight = StrictMath.atan2(dyM, dxM)
    val ahead = StrictMath.asin((speedRatio * StrictMath.sin(opponentHeadingRad - sight)).max(-1.0).min(1.0))
    Turn.towards(ownHeadingRad, sight + lead * ahead, turnRateRadPerS * elapsedS)
