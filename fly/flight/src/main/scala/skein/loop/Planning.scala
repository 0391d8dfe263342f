package skein.loop

import skein.planning.*
import skein.policy.{Agent, Fleet, Goal, HeadingPolicy, Role}
import skein.record.PlannedPath
import skein.units.*
import skein.vehicle.{PlaneReading, VehicleKind}

/** Plans for one vehicle of a scenario: the pure core of the `plan` loop, which its replay uses too.
  *
  * @param foreseen how the vehicle is
  */
private abstract class Planning(
    fleet: Fleet,
    self: Int,
    settings: PlanSettings,
    protected val foreseen: ForeseenVehicle
):
  protected val agent: Agent     = fleet.agents(self)
  protected val decider: Decider = Decider(fleet, self)
  private val startM             = -agent.startPositionNed.z

  /** At which it flies: its start's, as far as the limits let it. */
  protected val altitudeM: Double = settings.altitudeM(startM)

  final val planner: PlannerSettings = settings.planner

  /** How long after its arrival a command begins to act on the vehicle. */
  final val deadTime: Span = Span.ofSeconds(foreseen.plant.deadTimeS)

  /** Whether plans depend on more vehicles than this one and its opponent. */
  def regardsTeam: Boolean

  /** What is planned upon, from a view with the estimates of when the command will act. */
  def pose(memory: Memory, view: TeamView, now: Instant): Part

  /** What the vehicle's policy does in the plan's place. */
  protected def byPolicy(memory: Memory, view: TeamView, now: Instant, part: Part): PlannedMove

  /** Whether speeds are planned too. */
  protected def choosesSpeed: Boolean

  /** The decision for what was found.
    *
    * @param part in whose situation it keeps apart from the planned ways of others too
    * @param isOld whether the vehicle's policy decides in the plan's place
    */
  final def decide(
      memory: Memory,
      view: TeamView,
      now: Instant,
      part: Part,
      plan: Plan,
      isOld: Boolean
  ): (Memory, PlannedDecision) =
    val chosen = if isOld then None else Some(begun(part, plan))
    val action = chosen.fold(byPolicy(memory, view, now, part))(manoeuvre =>
      PlannedMove.of(plan.copy(manoeuvre = manoeuvre), part.situation, part.objective, planner.dtS)
    )
    val speed            = Option.when(choosesSpeed)(MetresPerSecond(action.speed))
    val (next, decision) =
      decider.decided(memory, view, now, memory.headingRad + action.turned, speed)
    (next, PlannedDecision(atAltitude(decision), action, plan, isOld, chosen.map(course(part, _))))

  /** Where the plan leads. */
  private def course(part: Part, manoeuvre: Manoeuvre): PlannedPath =
    val track = ManoeuvreRollout(part.situation, part.objective, planner.dtS).track(manoeuvre)
    val steps = Vector.range(0, track.steps)
    PlannedPath(steps.map(track.x), steps.map(track.y), Span.ofSeconds(planner.dtS))

  private def atAltitude(decision: Decision): Decision =
    if altitudeM == startM then decision
    else
      val velocity = agent.velocityNed(decision.heading.value, decision.speed)
      decision.copy(action = Some(skein.policy.Action.VelocityAt(velocity.x, velocity.y, Metres(-altitudeM))))

  /** The plan's manoeuvre where it costs clearly less than every one suggested. */
  private def begun(part: Part, plan: Plan): Manoeuvre =
    val rollout = ManoeuvreRollout(part.situation, part.objective, planner.dtS)
    val enough  = rollout.fly(plan.manoeuvre).cost + Planning.ClearGain
    part.situation.suggested.find(rollout.fly(_).cost < enough).getOrElse(plan.manoeuvre)

/** A decision that was planned, and how.
  *
  * @param byPolicy whether the last plan was too old to go on with
  * @param course where the plan leads; absent where the policy decides in its place
  */
final case class PlannedDecision(
    decision: Decision,
    action: PlannedMove,
    plan: Plan,
    byPolicy: Boolean,
    course: Option[PlannedPath] = None
):
  /** @param slices that each search has finished
    */
  def report(slices: Vector[Int]): PlanReport = PlanReport(
    plan.candidates,
    slices,
    Option.when(plan.cost.isFinite)(plan.cost.toDouble),
    isSearched = plan.slices > 0,
    byPolicy,
    action.breaches.size,
    action.breaches.headOption.map(_.toString),
    course
  )

/** What is on record of how a decision was planned.
  *
  * @param candidates flown by all searches together
  * @param slices that each search has finished
  * @param cost of the plan; absent where none was tried
  * @param isSearched whether any search finished a slice for this vehicle
  * @param byPolicy whether the last plan was too old to go on with
  * @param breaches of hard limits within the plan's horizon, of which `breach` is the first
  * @param course where the plan leads; absent where the policy decides in its place
  */
final case class PlanReport(
    candidates: Long,
    slices: Vector[Int],
    cost: Option[Double],
    isSearched: Boolean,
    byPolicy: Boolean,
    breaches: Int,
    breach: Option[String],
    course: Option[PlannedPath]
)

/** Which vehicles plan, and how their plans begin. */
object Planning:

  /** Whether a vehicle's decisions are planned; else its policy decides. Plans are a multirotor's: they turn
    * on the spot.
    */
  private[loop] def plans(agent: Agent): Boolean =
    agent.kind == VehicleKind.Multirotor && (agent.policy match
      case _: Goal          => true
      case _: HeadingPolicy => agent.role == Role.Pursuer
      case _                => false)

  /** Which vehicles plan and which do not, in a line for the user.
    *
    * @return or that none would: the flight would be that of `predictive` under another name
    */
  def told(fleet: Fleet): Either[String, String] =
    val (planned, others)            = fleet.agents.partition(plans)
    def names(agents: Vector[Agent]) =
      val more = agents.size - MostNamed
      agents.take(MostNamed).map(_.name).mkString(", ") + (if more > 0 then s" and $more more" else "")
    Either.cond(
      planned.nonEmpty,
      s"plan: ${names(planned)} ${if planned.sizeIs == 1 then "plans" else "plan"}; " +
        (if others.isEmpty then "there is nobody else"
         else
           s"${names(others)} ${
               if others.sizeIs == 1 then "flies by its own policy" else "fly by their own policies"
             }"),
      "plan: expected a multirotor that can plan, by a policy with a Goal or by a HeadingPolicy that " +
        s"pursues one opponent, came none: ${names(others)} would fly by their own policies"
    )

  private val MostNamed = 8

  /** By which a plan must cost less than what the policy would do, to be begun with. A search that has the
    * time to find every small gain follows the simple model, and guesses of other vehicles, where they are
    * wrong, too; the policy does not. Vehicles that are where they want to be fly by it, and by plans where
    * these save some 0.1 m for a second.
    */
  private val ClearGain = 0.1

  /** After a longer pause a vehicle turns no further at once than in this time, s. */
  private val LongestTurnS = 0.5

  /** The random numbers of a vehicle's next plan. */
  private[loop] def stream(seed: Long, self: Int, memory: Memory): Long =
    (seed * 1_000_003 + self) * 1_000_003 + memory.decisions

  /** How long the vehicle may turn at once, s. Where a solver decided last, its clock, as far as it is known,
    * may be ahead.
    */
  private[loop] def sinceDecisionS(memory: Memory, now: Instant): Double =
    memory.decidedAt.fold(0.0)(at => now.since(at).toSeconds.max(0).min(LongestTurnS))

  private[loop] def straight(motion: PlaneReading, planner: PlannerSettings): PredictedTrack =
    PredictedTrack.straight(motion, planner.steps, planner.dtS)

  /** The vehicles of which nothing is planned, but for one. */
  private[loop] def unplanned(fleet: Fleet, but: Int): Vector[Int] =
    fleet.agents.indices.toVector.filter(other => other != but && !plans(fleet.agents(other)))
