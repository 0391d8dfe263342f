package skein.planning

import skein.policy.{TeamPolicy, TeamObservation}

/** What a vehicle's own policy would do, as a manoeuvre. */
object PolicyManoeuvre:

  /** The policy is asked before each step of the horizon, where the vehicle has then flown under its answers,
    * and all others straight on. Its headings are met as fast as the limits allow.
    *
    * @param observation at the beginning
    * @param situation of the same vehicle at the same moment
    */
  def of(
      policy: TeamPolicy,
      observation: TeamObservation,
      situation: Situation,
      limits: CommandLimits,
      steps: Int,
      dtS: Double
  ): Manoeuvre =
    var own: PredictedVehicle[?]                   = situation.own
    val (turns, speeds)                            = (Array.ofDim[Float](steps), Array.ofDim[Float](steps))
    var heading                                    = situation.headingRad
    def ownIn(values: IArray[Double], own: Double) = values.updated(observation.self, own)
    for step <- 0 until steps do
      val aheadS = step * dtS
      val at     = own.motion
      val turnS  = if step == 0 then situation.sinceDecisionS else dtS
      val course = policy.course(
        observation.copy(
          northM = ownIn(later(observation.northM, observation.northMps, aheadS), at.northM),
          eastM = ownIn(later(observation.eastM, observation.eastMps, aheadS), at.eastM),
          northMps = ownIn(observation.northMps, at.northMps),
          eastMps = ownIn(observation.eastMps, at.eastMps),
          headingRad = heading,
          elapsedS = turnS
        )
      )
      val speed = math.min(math.max(course.speedMps, limits.minSpeed), limits.maxSpeed)
      val most  = limits.turnRateAt(speed)
      val turn  = math.IEEEremainder(course.headingRad - heading, 2 * math.Pi)
      val rate  = if turnS > 0 then math.min(math.max(turn / turnS, -most), most) else 0.0
      turns(step) = rate.toFloat
      speeds(step) = speed.toFloat
      heading += rate * turnS
      own = own.flown(speed * StrictMath.cos(heading), speed * StrictMath.sin(heading), dtS)
    Manoeuvre(IArray.unsafeFromArray(turns), IArray.unsafeFromArray(speeds))

  private def later(places: IArray[Double], velocities: IArray[Double], aheadS: Double): IArray[Double] =
    IArray.tabulate(places.length)(index => places(index) + velocities(index) * aheadS)
