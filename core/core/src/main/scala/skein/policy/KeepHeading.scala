package skein.policy

/** Keeps the last commanded heading; used to repeat the last decision when a policy has not decided in time.
  */
object KeepHeading extends HeadingPolicy.Memoryless:

  def heading(seen: PlanarObservation): Double =
    import seen.*
    ownHeadingRad
