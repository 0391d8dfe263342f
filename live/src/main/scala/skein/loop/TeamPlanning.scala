package skein.loop

import skein.flow.Plan
import skein.planning.*
import skein.policy.{GoalPolicy, Scenario}
import skein.units.*
import skein.vehicle.ReducedModel

/** Plans for one vehicle of a team, by itself: to be where its policy wants to be, and to keep the set separation from all
  * others. They are taken to fly straight on: what is commanded to them changes faster than their velocities.
  *
  * The separation planned for is wider than the set one by [[TeamPlanning.Doubt]], since the others plan too, and turn.
  * Of the others, the nearest [[TeamPlanning.Regarded]] count, and only those that can be met within the horizon.
  *
  * Where nothing was searched for half a horizon, the vehicle's own policy decides.
  */
private final class TeamPlanning(
    scenario: Scenario,
    self: Int,
    policy: GoalPolicy,
    settings: PlanSettings,
    seed: Long
) extends Planning:
  import Planning.{motion, straight}
  private val agent    = scenario.agents(self)
  private val decider  = Decider(scenario, self)
  private val response =
    if settings.response == ReducedModel.AirSim then ReducedModel.airSimAt(agent.startPositionNed.z)
    else settings.response.copy(turnLagS = settings.response.lagS)
  private val minimumM = policy.minimumM.max(settings.separationM)

  val planner: PlannerSettings = settings.planner
  val deadTime: Span           = Span.ofSeconds(response.deadTimeS)

  val objective: Objective = Objective(
    Limits(0, policy.mostMps, TeamPlanning.MostTurnRadps),
    distance = 1,
    carried = 0.5,
    turning = 0.1,
    speedChange = 0.05,
    cruiseSpeed = agent.speed.value,
    separation =
      if minimumM > 0 then Separation(minimumM + TeamPlanning.Doubt, margin = 0.8, growth = 0.5)
      else Separation(0, 0, 0),
    geofence = settings.geofence
  )

  def regardsTeam: Boolean = true

  def pose(memory: Memory, picture: Picture, now: Instant): (Situation, Long) =
    val sight  = decider.sight(memory, picture, now)
    val own    = motion(picture.kinematics(self))
    val stream = Planning.stream(seed, self, memory)
    val wanted = Vector.tabulate(planner.steps)(step => policy.wanted(sight, (step + 1) * planner.dtS))
    val others = if minimumM == 0 then Vector.empty else near(own, picture)
    (
      Situation(
        own,
        memory.headingRad,
        Planning.sinceDecisionS(memory, now),
        response,
        Vector(Behaviour(Target.Along(PredictedTrack(
          IArray.from(wanted.map(_._1)),
          IArray.from(wanted.map(_._2))
        )))),
        others
      ),
      stream
    )

  private def near(own: Motion, picture: Picture): Vector[PredictedTrack] =
    val reachM = minimumM + 2 * policy.mostMps * planner.horizonS
    scenario.agents.indices.toVector
      .filter(_ != self)
      .map(other => motion(picture.kinematics(other)))
      .map(other => (other, math.hypot(other.x - own.x, other.y - own.y)))
      .filter(_._2 < reachM)
      .sortBy(_._2)
      .take(TeamPlanning.Regarded)
      .map((other, _) => straight(other, planner))

  def decide(
      memory: Memory,
      picture: Picture,
      now: Instant,
      situation: Situation,
      answer: Plan.Answer
  ): (Memory, PlannedDecision) =
    val byPolicy = Planning.isOutdated(answer, planner)
    val action   =
      if !byPolicy then Action.of(answer.best, situation, objective, planner.dtS)
      else
        val course = policy.course(decider.sight(memory, picture, now))
        Action(course.headingRad - memory.headingRad, course.speedMps, Vector.empty)
    val (next, decision) = decider.decided(
      memory,
      picture,
      now,
      memory.headingRad + action.turned,
      Some(MetresPerSecond(action.speed))
    )
    (next, PlannedDecision(decision, action, answer, byPolicy))

private object TeamPlanning:
  /** On top of the set separation, m. */
  val Doubt = 1.3

  /** Other vehicles that a plan regards. */
  val Regarded = 8

  /** Of a multirotor that turns on the spot: as fast as plans of 0.1 s steps can turn. */
  val MostTurnRadps = 4.0
