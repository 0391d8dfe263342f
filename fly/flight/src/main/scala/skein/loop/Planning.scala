package skein.loop

import skein.planning.*
import skein.policy.{Action, Agent, Fleet, Goal, Role}
import skein.record.PlannedPath
import skein.units.*
import skein.vehicle.{PlaneReading, VehicleKind}

/** Plans for one vehicle of a scenario: the pure core of the `plan` loop, also used by its replay.
  *
  * @param foreseen the model that predicts the vehicle
  */
private abstract class Planning(
    fleet: Fleet,
    self: Int,
    settings: PlanSettings,
    protected val foreseen: ForeseenVehicle
):
  protected val agent: Agent     = fleet.agents(self)
  protected val decider: Decider = Decider(fleet, self)

  /** Altitude of the plan: that of the vehicle's start, within the limits. */
  private val down =
    val start = agent.startPositionNed.z
    Metres(if settings.altitudeM(-start) == -start then start else -settings.altitudeM(-start))

  final val planner: PlannerSettings = settings.planner

  /** Time from a command's arrival until it takes effect on the vehicle. */
  final val deadTime: Span = Span.ofSeconds(foreseen.plant.deadTimeS)

  /** Whether plans depend on other vehicles than this one and its opponent. */
  def regardsTeam: Boolean

  /** The planning problem, from a view with the estimates for the time at which the command takes effect. */
  def pose(memory: Memory, view: TeamView, now: Instant): Part

  /** The decision of the vehicle's policy instead of the plan. */
  protected def byPolicy(memory: Memory, view: TeamView, now: Instant, part: Part): PlannedMove

  protected def choosesSpeed: Boolean

  /** The decision for the plan found.
    *
    * @param part the planning problem, whose situation includes the planned tracks of the other vehicles
    * @param slices number of slices that each search has finished
    * @param isOld whether the vehicle's policy decides instead of the plan
    */
  final def decide(
      memory: Memory,
      view: TeamView,
      now: Instant,
      part: Part,
      plan: Plan,
      slices: Vector[Int],
      isOld: Boolean
  ): (Memory, PlannedDecision) =
    val chosen = if isOld then None else Some(begun(part, plan))
    val action = chosen.fold(byPolicy(memory, view, now, part))(manoeuvre =>
      PlannedMove.of(plan.copy(manoeuvre = manoeuvre), part.situation, part.objective, planner.dtS)
    )
    val heading          = Radians(memory.headingRad + action.turned)
    val speed            = if choosesSpeed then MetresPerSecond(action.speed) else agent.speed
    val (next, decision) = decider.decided(memory, view, now, Action.Along(heading, speed, down))
    val report           = PlanReport(
      plan.candidates,
      slices,
      Option.when(plan.cost.isFinite)(plan.cost.toDouble),
      isSearched = plan.slices > 0,
      byPolicy = isOld,
      action.breaches.size,
      action.breaches.headOption.map(_.text),
      chosen.map(course(part, _))
    )
    (next, PlannedDecision(decision, report))

  private def course(part: Part, manoeuvre: Manoeuvre): PlannedPath =
    val track = ManoeuvreRollout(part.situation, part.objective, planner.dtS).track(manoeuvre)
    val steps = Vector.range(0, track.steps)
    PlannedPath(steps.map(track.x), steps.map(track.y), Span.ofSeconds(planner.dtS))

  /** The plan's manoeuvre if it costs clearly less than every suggested one. */
  private def begun(part: Part, plan: Plan): Manoeuvre =
    val rollout = ManoeuvreRollout(part.situation, part.objective, planner.dtS)
    val enough  = rollout.fly(plan.manoeuvre).cost + Planning.ClearGain
    part.situation.suggested.find(rollout.fly(_).cost < enough).getOrElse(plan.manoeuvre)

/** A decision with the plan behind it, as recordings have it. */
final case class PlannedDecision(decision: Decision, plan: PlanReport)

/** The recorded data of a planned decision.
  *
  * @param candidates number of candidates that all searches simulated together
  * @param slices number of slices that each search has finished
  * @param cost cost of the plan; absent if none was simulated
  * @param isSearched whether any search finished a slice for this vehicle
  * @param byPolicy whether the last plan was too old to continue
  * @param breaches number of violations of hard limits within the plan's horizon, of which `breach` is the
  *   first
  * @param course the planned path; absent if the policy decides instead
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

/** The choice of vehicles that plan, and the constants of their plans. */
object Planning:

  /** Whether a vehicle's decisions are planned; else its policy decides. Plans are for multirotors: they turn
    * on the spot.
    */
  private[loop] def plans(agent: Agent): Boolean =
    agent.kind == VehicleKind.Multirotor && (agent.policy match
      case _: Goal => true
      case policy  => policy.isAgainstOne && agent.role == Role.Pursuer)

  /** The vehicles that plan and those that do not, in a line for the user.
    *
    * @return Left if no vehicle would plan: then the flight would be that of `predictive` under another name
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
      "plan: expected a multirotor that can plan, by a policy with a Goal or by one that " +
        s"pursues one opponent, got none: ${names(others)} would fly by their own policies"
    )

  private val MostNamed = 8

  /** The cost advantage that a plan needs over the policy's manoeuvre in order to be followed. A long search
    * exploits every small gain of the simple model and of guesses about other vehicles, even if these are
    * wrong; the policy does not. Vehicles at their goals follow the policy, and plans only if these save some
    * 0.1 m for a second.
    */
  private val ClearGain = 0.1

  /** The random stream of a vehicle's next plan. */
  private[loop] def stream(seed: Long, self: Int, memory: Memory): Long =
    (seed * 1_000_003 + self) * 1_000_003 + memory.decisions

  /** Time since the last decision, s. The clock of a solver that decided last may be ahead within its error.
    */
  private[loop] def sinceDecisionS(memory: Memory, now: Instant): Double =
    memory.decidedAt.fold(0.0)(at => now.since(at).toSeconds.max(0))

  private[loop] def straight(motion: PlaneReading, planner: PlannerSettings): PredictedTrack =
    PredictedTrack.straight(motion, planner.steps, planner.dtS)

  /** The vehicles that are not planned, except one. */
  private[loop] def unplanned(fleet: Fleet, but: Int): Vector[Int] =
    fleet.agents.indices.toVector.filter(other => other != but && !plans(fleet.agents(other)))
