package skein.policy

/** Pure proportional navigation: turns N times as fast as the line of sight rotates, so that the line of
  * sight stops rotating. Against a target that does not manoeuvre, the course then becomes a straight line to
  * the intercept. While the distance does not decrease, the law would turn away; then the policy turns
  * towards the target instead.
  *
  * Line of sight rate: (dx·dvy − dy·dvx) / (dx² + dy²), from relative position and velocity. Source: Zarchan,
  * Tactical and Strategic Missile Guidance, chapter 2.
  *
  * @param gain N; above 2 for a course that becomes straight; 3 to 5 in practice
  * @param turnRateRadPerS maximum turn rate
  */
final case class ProportionalNavigation(gain: Double = 3.0, turnRateRadPerS: Double = 1.0)
    extends HeadingPolicy.Memoryless:
  require(gain > 0, s"the gain must be positive, got $gain")
  require(turnRateRadPerS > 0, s"the turn rate must be positive, got $turnRateRadPerS rad/s")

  def heading(seen: PlanarObservation): Double =
    import seen.*
    val most      = turnRateRadPerS * elapsedS
    val isClosing = dxM * dvxMps + dyM * dvyMps < 0
    if isClosing then
      val sightRate = (dxM * dvyMps - dyM * dvxMps) / (dxM * dxM + dyM * dyM)
      ownHeadingRad + Turn.limited(gain * sightRate * elapsedS, most)
    else Turn.towards(ownHeadingRad, StrictMath.atan2(dyM, dxM), most)
