package skein.policy

/** Keeps the last commanded heading: repeats the last decision where a policy has not decided in time. */
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
