package skein.planning

import skein.policy.{Observation, Policy}
import skein.units.{Radians, Span, Vector3}
import skein.vehicle.PlaneReading

/** Converts a policy's decisions to a manoeuvre, as a candidate for a search. */
object PolicyManoeuvre:

  /** Evaluates the policy before each step of the horizon. In these observations this vehicle has followed
    * its earlier decisions, and all others fly straight on. Headings are followed as fast as the limits
    * allow.
    *
    * @param memory the policy's present memory
    * @param observation the present observation
    * @param situation the vehicle's present situation
    */
  def of(
      policy: Policy,
      memory: Any,
      observation: Observation,
      situation: Situation,
      limits: CommandLimits,
      steps: Int,
      dtS: Double
  ): Manoeuvre =
    var own: PredictedVehicle[?] = situation.own
    val (turns, speeds)          = (Array.ofDim[Float](steps), Array.ofDim[Float](steps))
    var heading                  = situation.headingRad
    var held                     = memory
    for step <- 0 until steps do
      val turnS          = if step == 0 then situation.firstTurnS else dtS
      val seen           = later(observation, own.motion, step * dtS, heading, turnS)
      val (action, next) = policy.choose(seen, held.asInstanceOf[policy.Memory])
      held = next
      val speed = math.min(math.max(action.speed.value, limits.minSpeed), limits.maxSpeed)
      val most  = limits.turnRateAt(speed)
      val turn  = math.IEEEremainder(action.headingRad(heading) - heading, 2 * math.Pi)
      val rate  = if turnS > 0 then math.min(math.max(turn / turnS, -most), most) else 0.0
      turns(step) = rate.toFloat
      speeds(step) = speed.toFloat
      heading += rate * turnS
      own = own.flown(speed * StrictMath.cos(heading), speed * StrictMath.sin(heading), dtS)
    Manoeuvre(IArray.unsafeFromArray(turns), IArray.unsafeFromArray(speeds))

  /** The observation after this vehicle has reached this state, while the others flew straight on. */
  private def later(
      seen: Observation,
      own: PlaneReading,
      aheadS: Double,
      headingRad: Double,
      elapsedS: Double
  ): Observation =
    val vehicles = seen.vehicles.zipWithIndex.map: (each, vehicle) =>
      val (at, velocity) = (each.kinematics.positionNed, each.kinematics.velocityNed)
      val kinematics     =
        if vehicle == seen.self then
          each.kinematics.copy(
            positionNed = Vector3(own.northM, own.eastM, at.z),
            velocityNed = Vector3(own.northMps, own.eastMps, velocity.z)
          )
        else
          each.kinematics.copy(positionNed =
            Vector3(at.x + velocity.x * aheadS, at.y + velocity.y * aheadS, at.z)
          )
      each.copy(kinematics = kinematics)
    seen.copy(
      vehicles = vehicles,
      headings = seen.headings.updated(seen.self, Radians(headingRad)),
      elapsed = Span.ofSeconds(elapsedS)
    )
