package skein.loop

import skein.planning.*
import skein.policy.{Agent, GoalPolicy, PaperEvader, Policy, Role, Scenario, TeamPolicy}
import skein.record.Decision
import skein.signal.Kinematics
import skein.units.*

/** Plans for one vehicle of a scenario: the pure core of the `plan` loop, which its replay uses too. */
trait Planning:
  def planner: PlannerSettings
  def objective: Objective

  /** How long after its arrival a command begins to act on the vehicle. */
  def deadTime: Span

  /** Whether plans depend on more vehicles than this one and its opponent. */
  def regardsTeam: Boolean

  /** What is planned upon, from a picture with the estimates of when the command will act. */
  def pose(memory: Memory, picture: Picture, now: Instant): Part

  /** The decision for what was found.
    *
    * @param situation
    *   in which it keeps apart from the planned ways of others too
    * @param byPolicy
    *   whether the vehicle's policy decides in the plan's place
    */
  def decide(
      memory: Memory,
      picture: Picture,
      now: Instant,
      situation: Situation,
      plan: Plan,
      byPolicy: Boolean
  ): (Memory, PlannedDecision)

/** A decision that was planned, and how.
  *
  * @param byPolicy
  *   whether the last plan was too old to go on with
  */
final case class PlannedDecision(decision: Decision, action: Action, plan: Plan, byPolicy: Boolean)

object Planning:

  /** Whether a vehicle's decisions are planned; else its policy decides. */
  private[loop] def plans(agent: Agent): Boolean = agent.policy match
    case _: Policy     => agent.role == Role.Pursuer
    case _: GoalPolicy => true
    case _: TeamPolicy => false

  /** How a vehicle's decisions are planned; absent where its policy decides.
    *
    * @param seed
    *   of the search's random numbers
    */
  def of(scenario: Scenario, self: Int, settings: PlanSettings, seed: Long): Option[Planning] =
    val agent = scenario.agents(self)
    Option.when(plans(agent)):
      agent.policy match
        case goal: GoalPolicy => TeamPlanning(scenario, self, goal, settings, seed)
        case _                => PursuitPlanning(scenario, self, settings, seed)

  /** After a longer pause a vehicle turns no further at once than in this time, s. */
  private val LongestTurnS = 0.5

  /** The random numbers of a vehicle's next plan. */
  private[loop] def stream(seed: Long, self: Int, memory: Memory): Long =
    (seed * 1_000_003 + self) * 1_000_003 + memory.decisions

  /** How long the vehicle may turn at once, s. */
  private[loop] def sinceDecisionS(memory: Memory, now: Instant): Double =
    memory.decidedAt.fold(0.0)(at => math.min(now.since(at).toSeconds, LongestTurnS))

  private[loop] def motion(seen: Kinematics): Motion =
    Motion(seen.positionNed.x, seen.positionNed.y, seen.velocityNed.x, seen.velocityNed.y)

  private[loop] def straight(motion: Motion, planner: PlannerSettings): PredictedTrack =
    PredictedTrack.straight(motion, planner.steps, planner.dtS)

  /** The vehicles of which nothing is planned, but for one. */
  private[loop] def unplanned(scenario: Scenario, but: Int): Vector[Int] =
    scenario.agents.indices.toVector.filter(other => other != but && !plans(scenario.agents(other)))

/** Plans for a pursuer of the paper's game: to be as close to its evader as it can, on the average and at the end of the
  * horizon, and to capture it.
  *
  * Its turn rate stays below speed / turning radius. The evader is taken to fly by its policy where that is the paper's,
  * which answers to the pursuer's commands; else to fly straight on. Of all others, those that plan fly by their plans, the
  * rest straight on.
  *
  * In its place the vehicle's own policy decides within the turn limit.
  */
private final class PursuitPlanning(scenario: Scenario, self: Int, settings: PlanSettings, seed: Long)
    extends Planning:
  import Planning.{motion, straight}
  private val agent    = scenario.agents(self)
  private val speed    = agent.speed.value
  private val decider  = Decider(scenario, self)
  private val response = settings.response.copy(turnLagS = settings.response.lagS)

  val planner: PlannerSettings = settings.planner
  val deadTime: Span           = Span.ofSeconds(response.deadTimeS)

  val objective: Objective = Objective(
    Limits(speed * settings.slowestShare, speed, speed / settings.turningRadiusM, settings.turningRadiusM),
    carried = PursuitPlanning.Carried,
    closest = PursuitPlanning.Closest,
    capture = PursuitPlanning.Capture,
    cruiseSpeed = speed,
    separation = Separation(settings.separationM, margin = if settings.separationM > 0 then 1 else 0),
    geofence = settings.geofence
  )

  def regardsTeam: Boolean = settings.separationM > 0

  def pose(memory: Memory, picture: Picture, now: Instant): Part =
    val opponent = scenario.opponentOf(self, picture.kinematics(_).positionNed)
    val stream   = Planning.stream(seed, self, memory)
    val others   =
      if regardsTeam then Planning.unplanned(scenario, but = opponent) else Vector.empty
    val situation = Situation(
      motion(picture.kinematics(self)),
      memory.headingRad,
      Planning.sinceDecisionS(memory, now),
      response,
      Behaviours.around(target(opponent, motion(picture.kinematics(opponent))), settings.behaviours, stream),
      others.map(other => straight(motion(picture.kinematics(other)), planner))
    )
    Part(objective, situation, stream)

  private def target(opponent: Int, motion: Motion): Target = scenario.agents(opponent).policy match
    case paper: PaperEvader =>
      Target.paperEvader(motion, response, scenario.agents(opponent).speed.value, paper)
    case _ => Target.Along(straight(motion, planner))

  def decide(
      memory: Memory,
      picture: Picture,
      now: Instant,
      situation: Situation,
      plan: Plan,
      byPolicy: Boolean
  ): (Memory, PlannedDecision) =
    val action =
      if !byPolicy then Action.of(plan, situation, objective, planner.dtS)
      else
        val (_, decision) = decider.decide(memory, picture, now)
        val most          = objective.limits.turnRateAt(speed) * situation.sinceDecisionS
        val turned        = decision.heading.value - memory.headingRad
        Action(math.min(math.max(turned, -most), most), speed, Vector.empty)
    val chosen           = Option.when(settings.slowestShare < 1)(MetresPerSecond(action.speed))
    val (next, decision) =
      decider.decided(memory, picture, now, memory.headingRad + action.turned, chosen)
    (next, PlannedDecision(decision, action, plan, byPolicy))

private object PursuitPlanning:
  /** Weights of [[skein.planning.Objective]]; see there. */
  val Carried = 0.0
  val Closest = 1.0
  val Capture = 3.0
