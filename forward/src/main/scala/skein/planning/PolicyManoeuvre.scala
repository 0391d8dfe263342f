package skein.planning

import skein.policy.{TeamPolicy, TeamObservation}

/** What a vehicle's own policy would do, as a manoeuvre. */
object PolicyManoeuvre:

  /** The policy is asked before each step of the horizon, where the vehicle has then flown under its answers, and all
    * others straight on. Its headings are met as fast as the limits allow.
    *
    * @param observation
    *   at the beginning
    * @param situation
    *   of the same vehicle at the same moment
    */
  def of(
      policy: TeamPolicy,
      observation: TeamObservation,
      situation: Situation,
      limits: Limits,
      steps: Int,
      dtS: Double
  ): Manoeuvre =
    val flyer           = ManoeuvreRollout.Flyer(situation.own, situation.response, dtS)
    val (turns, speeds) = (Array.ofDim[Float](steps), Array.ofDim[Float](steps))
    var heading         = situation.headingRad
    def ownIn(values: IArray[Double], own: Double) = values.updated(observation.self, own)
    for step <- 0 until steps do
      val aheadS = step * dtS
      val turnS  = if step == 0 then situation.sinceDecisionS else dtS
      val course = policy.course(
        observation.copy(
          northM = ownIn(later(observation.northM, observation.northMps, aheadS), flyer.x),
          eastM = ownIn(later(observation.eastM, observation.eastMps, aheadS), flyer.y),
          northMps = ownIn(observation.northMps, flyer.vx),
          eastMps = ownIn(observation.eastMps, flyer.vy),
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
      flyer.fly(speed * StrictMath.cos(heading), speed * StrictMath.sin(heading))
    Manoeuvre(IArray.unsafeFromArray(turns), IArray.unsafeFromArray(speeds))

  private def later(places: IArray[Double], velocities: IArray[Double], aheadS: Double): IArray[Double] =
    IArray.tabulate(places.length)(index => places(index) + velocities(index) * aheadS)
