package skein.planning

/** The next command of a plan.
  *
  * @param turned angle from the last commanded heading, rad
  * @param speed commanded speed, m/s
  * @param breaches hard limits that the plan could not keep within its horizon
  */
final case class PlannedMove(turned: Double, speed: Double, breaches: Vector[Breached])

object PlannedMove:

  /** The first action of a plan, checked in doubles: speed and turn rate are clamped to the limits, and the
    * manoeuvre is simulated against geofences and separation. A search that finds a manoeuvre within the hard
    * limits never returns one beyond them, so a breach means that it found none.
    */
  def of(plan: Plan, situation: Situation, objective: PlanCost, dtS: Double): PlannedMove =
    val limits   = objective.limits
    val speed    = within(plan.manoeuvre.speeds(0), limits.minSpeed, limits.maxSpeed)
    val most     = limits.turnRateAt(speed)
    val turnRate = within(plan.manoeuvre.turnRates(0), -most, most)
    val flown    = ManoeuvreRollout(situation, objective, dtS).fly(plan.manoeuvre)
    PlannedMove(turnRate * situation.firstTurnS, speed, flown.breaches)

  private def within(value: Double, least: Double, most: Double): Double =
    math.min(math.max(value, least), most)
