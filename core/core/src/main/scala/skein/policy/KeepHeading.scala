package skein.policy

/** Goes on in the direction commanded last: what repeats a decision where a policy has not decided in time.
  */
object KeepHeading extends HeadingPolicy:

  def heading(
      dxM: Double,
      dyM: Double,
      dvxMps: Double,
      dvyMps: Double,
      ownHeadingRad: Double,
      opponentHeadingRad: Double,
      elapsedS: Double
  ): Double = ownHeadingRad
