package skein.policy

/** Keeps the last commanded heading: repeats the last decision where a policy has not decided in time. */
object KeepHeading extends HeadingPolicy.Memoryless:

  def heading(seen: PlanarObservation): Double =
    import seen.*
    ownHeadingRad
