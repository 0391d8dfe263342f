package skein.policy

/** Heads for the opponent's observed position, as fast as the turn rate allows.
  *
  * @param turnRateRadPerS maximum turn rate: v / R for a turning circle of radius R at speed v. The paper's
  *   pursuer turns 1 rad/s.
  */
final case class PurePursuit(turnRateRadPerS: Double = 1.0) extends HeadingPolicy.Memoryless:
  require(turnRateRadPerS > 0, s"the turn rate must be positive, got $turnRateRadPerS rad/s")

  def heading(seen: PlanarObservation): Double =
    import seen.*
    Turn.towards(ownHeadingRad, StrictMath.atan2(dyM, dxM), turnRateRadPerS * elapsedS)
