package skein.loop

import skein.planning.*
import skein.policy.Fleet
import skein.units.*
import skein.vehicle.PlantModel

/** Plans for a pursuer of the paper's game: to be as close to its evader as it can, on average and at the end
  * of the horizon, and to capture it.
  *
  * Its turn rate stays below speed / turning radius. The opponent is assumed to follow its policy with its
  * initial memory, if that plays against one vehicle and is a formula ([[OpponentModel]]); else to fly
  * straight on. Other vehicles that plan follow their plans, and the rest fly straight on.
  *
  * If the plan is too old, the vehicle's own policy decides within the turn limit.
  */
private final class PursuitPlanning(
    fleet: Fleet,
    self: Int,
    vehicles: Map[Int, ForeseenVehicle],
    settings: PlanSettings,
    seed: Long
) extends Planning(fleet, self, settings, vehicles(self)):
  import Planning.straight
  private val speed  = settings.speedMps(agent.speed.value)
  private val limitM = settings.separationM.max(settings.apartM)
  private val leastM = limitM.max(if settings.apartM > 0 then settings.apartM + PlanSettings.Doubt else 0)

  private val objective = PlanCost(
    CommandLimits(
      speed * settings.slowestShare,
      speed,
      speed / settings.turningRadiusM,
      settings.turningRadiusM
    ),
    carried = PursuitPlanning.Carried,
    closest = PursuitPlanning.Closest,
    capture = PursuitPlanning.Capture,
    cruiseSpeed = speed,
    separation = SeparationCost(leastM, margin = if leastM > 0 then 1 else 0, doubt = leastM - limitM),
    geofences = settings.geofences
  )

  def regardsTeam: Boolean = leastM > 0

  def pose(memory: Memory, view: TeamView, now: Instant): Part =
    val opponent = fleet.opponentOf(self, view.kinematics(_).positionNed)
    val stream   = Planning.stream(seed, self, memory)
    val others   =
      if settings.apartM > 0 then Planning.unplanned(fleet, but = self)
      else if regardsTeam then Planning.unplanned(fleet, but = opponent)
      else Vector.empty
    val situation = Situation(
      foreseen.at(view, self),
      memory.headingRad,
      Planning.sinceDecisionS(memory, now),
      Behaviours.around(target(opponent, view), settings.behaviours, stream),
      others.map(other => straight(PlantModel.readingOf(view.kinematics(other)), planner))
    )
    Part(objective, situation, stream)

  private def target(opponent: Int, view: TeamView): Target =
    OpponentModel.of(fleet.agents(opponent)) match
      case Right(policy) =>
        val speed = fleet.agents(opponent).speed.value
        val now   = vehicles(opponent).at(view, opponent)
        Target.Opponent(now, speed, view.headingRad(opponent, fleet), policy)
      case Left(_) => Target.Along(straight(PlantModel.readingOf(view.kinematics(opponent)), planner))

  protected def choosesSpeed: Boolean = settings.slowestShare < 1 || speed < agent.speed.value

  protected def byPolicy(memory: Memory, view: TeamView, now: Instant, part: Part): PlannedMove =
    val (_, decision) = decider.decide(memory, view, now)
    val most          = objective.limits.turnRateAt(speed) * part.situation.firstTurnS
    val turned        = decision.heading.value - memory.headingRad
    PlannedMove(math.min(math.max(turned, -most), most), speed, Vector.empty)

private object PursuitPlanning:
  /** Weights of the pursuit's cost; see [[skein.planning.PlanCost]]. */
  val Carried = 0.0
  val Closest = 1.0
  val Capture = 3.0
