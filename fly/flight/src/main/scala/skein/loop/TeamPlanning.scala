package skein.loop

import skein.planning.*
import skein.policy.{Fleet, Goal, Observation}
import skein.units.*
import skein.vehicle.PlantModel

/** Plans for one vehicle of a team: to reach its policy's goal, and to keep the configured separation from
  * all other vehicles. Vehicles that plan are assumed to follow their plans, the others to fly straight on.
  *
  * The planned separation is wider than the configured one by [[PlanSettings.Doubt]].
  */
private final class TeamPlanning(
    fleet: Fleet,
    self: Int,
    goal: Goal,
    foreseen: ForeseenVehicle,
    settings: PlanSettings,
    seed: Long
) extends Planning(fleet, self, settings, foreseen):
  import Planning.straight
  private val minimumM = goal.minimumM.max(settings.separationM).max(settings.apartM)

  private val objective = PlanCost(
    CommandLimits(0, settings.speedMps(goal.mostMps), TeamPlanning.MostTurnRad / settings.planner.dtS),
    distance = 1,
    carried = 0.5,
    turning = 0.002,
    speedChange = 0.1,
    cruiseSpeed = settings.speedMps(agent.speed.value),
    separation =
      if minimumM > 0 then
        SeparationCost(minimumM + PlanSettings.Doubt, margin = 0.8, growth = 0.5, doubt = PlanSettings.Doubt)
      else SeparationCost(0, 0, 0),
    geofences = settings.geofences,
    softness = 1
  )

  def regardsTeam: Boolean = true

  def pose(memory: Memory, view: TeamView, now: Instant): Part =
    val request = decider.observation(memory, view, now)
    val wanted  = Vector.tabulate(planner.steps)(step => placeWanted(request, (step + 1) * planner.dtS))
    val others  =
      if minimumM == 0 then Vector.empty
      else
        Planning.unplanned(fleet, but = self).map(other =>
          straight(PlantModel.readingOf(view.kinematics(other)), planner)
        )
    val along = PredictedTrack(IArray.from(wanted.map(_._1)), IArray.from(wanted.map(_._2)))
    val alone = Situation(
      foreseen.at(view, self),
      memory.headingRad,
      Planning.sinceDecisionS(memory, now),
      Vector(Behaviour(Target.Along(along))),
      others
    )
    val limits = turningAtOnce(alone.firstTurnS)
    Part(
      // The vehicle cruises at the speed of its goal; other speeds serve to catch up with it.
      objective.copy(limits = limits, cruiseSpeed = settings.speedMps(speed(along))),
      alone.copy(suggested = suggested(request, memory, alone, limits)),
      Planning.stream(seed, self, memory)
    )

  private def placeWanted(request: Observation, aheadS: Double): (Double, Double) =
    val place = PolicyAnswer.of(agent)(goal.wanted(request, aheadS))
    PolicyAnswer.expectAction(agent, place)
    place

  /** Limits of the first turn, which is no sharper after a longer pause. */
  private def turningAtOnce(firstTurnS: Double): CommandLimits =
    val most =
      if firstTurnS > 0 then TeamPlanning.MostTurnRad / firstTurnS else Double.PositiveInfinity
    objective.limits.copy(maxTurnRate = objective.limits.maxTurnRate.min(most))

  /** Mean speed from a track's first point to its last, m/s. */
  private def speed(track: PredictedTrack): Double =
    val last = track.steps - 1
    StrictMath.hypot(track.x(last) - track.x(0), track.y(last) - track.y(0)) / (last.max(1) * planner.dtS)

  /** The manoeuvre of the policy, unless the policy avoids other vehicles: it does not know their plans, and
    * a search is better at it.
    */
  private def suggested(
      request: Observation,
      memory: Memory,
      situation: Situation,
      limits: CommandLimits
  ): Vector[Manoeuvre] =
    if goal.minimumM > 0 then Vector.empty
    else
      val ways = PolicyManoeuvre
        .of(agent.policy, memory.held, request, situation, limits, planner.steps, planner.dtS)
      Vector(ways)

  protected def choosesSpeed: Boolean = true

  protected def byPolicy(memory: Memory, view: TeamView, now: Instant, part: Part): PlannedMove =
    val (action, _) = decider.answered(memory, view, now)
    val turn        = action.headingRad(memory.headingRad) - memory.headingRad
    PlannedMove(turn, settings.speedMps(action.speed.value), Vector.empty)

private object TeamPlanning:
  /** Maximum turn of a multirotor in a step. If it were less than the policy's turns, a vehicle could not
    * turn back in time.
    */
  val MostTurnRad = 1.0
