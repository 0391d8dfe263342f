package skein.policy

/** Chooses a heading for one vehicle from what it knows of its opponent. A pure function of its arguments, on
  * primitives, so that a live loop, virtual time and a batch of a million forward simulations call one object
  * without allocation.
  *
  * A policy's memory is the heading it commanded last. It must integrate over `elapsedS`, never count its
  * calls: deciding twice as often must not turn twice as fast.
  */
trait HeadingPolicy extends Policy:

  /** The heading to command now, rad, from north (+x) towards east (+y); any number of turns.
    *
    * @param dxM opponent's position minus own, north, m
    * @param dyM opponent's position minus own, east, m
    * @param dvxMps opponent's velocity minus own, north, m/s
    * @param dvyMps opponent's velocity minus own, east, m/s
    * @param ownHeadingRad heading commanded last to the own vehicle
    * @param opponentHeadingRad heading commanded last to the opponent, as far as known to this controller
    * @param elapsedS time since the own last decision; 0 at the first
    */
  def heading(
      dxM: Double,
      dyM: Double,
      dvxMps: Double,
      dvyMps: Double,
      ownHeadingRad: Double,
      opponentHeadingRad: Double,
      elapsedS: Double
  ): Double

  /** The heading that [[heading]] chooses for an observation. */
  final def headingFor(seen: PlanarObservation): Double =
    import seen.*
    heading(dxM, dyM, dvxMps, dvyMps, ownHeadingRad, opponentHeadingRad, elapsedS)

  /** This policy as an opponent with rough knowledge assumes it, such as a planner that plays against it: its
    * parameters deviate by random numbers. By default it is known exactly.
    *
    * @param draw samples of the standard normal distribution, by index
    */
  def guessed(draw: Int => Double): HeadingPolicy = this

  final override def isAgainstOne: Boolean = true

  final override def isPlanar: Boolean = true

  type Memory = Any

  /** The initial memory: none, except for an [[ObservingPolicy]]. */
  def start: Any = ()

  def choose(seen: Observation, memory: Any): (Action, Any) =
    (seen.along(headingFor(PlanarObservation.of(seen)), seen.cruise.value), memory)
