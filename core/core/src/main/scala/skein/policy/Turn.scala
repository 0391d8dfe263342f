package skein.policy

/** Changes of heading within a limit on the turn rate. */
private[policy] object Turn:

  /** Turns towards a wanted heading by the shorter way, by at most `mostRad`. If the wanted heading is
    * exactly opposite, its sign decides the side, so that a mirrored case turns to the mirrored side.
    */
  def towards(ownHeadingRad: Double, wantedRad: Double, mostRad: Double): Double =
    ownHeadingRad + limited(math.IEEEremainder(wantedRad - ownHeadingRad, 2 * math.Pi), mostRad)

  def limited(turnRad: Double, mostRad: Double): Double =
    if turnRad > mostRad then mostRad else if turnRad < -mostRad then -mostRad else turnRad
