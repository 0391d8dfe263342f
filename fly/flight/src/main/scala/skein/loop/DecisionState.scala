package skein.loop

import skein.loop.planning.PlanStage
import skein.planning.{JointPlanner, PlanProblem}
import skein.units.Instant

/** The state for repeating the decisions of vehicles that decide together, with their memories. Immutable
  * except for scratch memory.
  */
private sealed trait DecisionState:
  def vehicles: Vector[Int]

  /** Whether a vehicle's decisions depend on others than itself and its opponent. */
  def regardsTeam(vehicle: Int): Boolean

  /** Repeats a decision of each vehicle.
    *
    * @param views a view for each vehicle
    * @param slices number of slices of each search, if they plan
    */
  def decide(views: Vector[TeamView], now: Instant, slices: Vector[Int]): DecisionState.Made

  /** Decides once by others, one for each vehicle. */
  def decideBy(others: Vector[Decider], views: Vector[TeamView], now: Instant): DecisionState.Made

  /** This state as a solver has it that remembers nothing. */
  def begunAnew: DecisionState

private object DecisionState:
  /** The next state, and the decision of each vehicle. */
  type Made = (DecisionState, Vector[Decision])

/** One vehicle, which decides by its policy. */
private final class SingleState(vehicle: Int, decider: Decider, memory: Memory) extends DecisionState:
  val vehicles: Vector[Int] = Vector(vehicle)

  def regardsTeam(vehicle: Int): Boolean = decider.regardsTeam

  def decide(views: Vector[TeamView], now: Instant, slices: Vector[Int]): DecisionState.Made =
    after(decider.decide(memory, views.head, now))

  def decideBy(others: Vector[Decider], views: Vector[TeamView], now: Instant): DecisionState.Made =
    after(others.head.decideInstead(memory, views.head, now))

  private def after(made: (next: Memory, decision: Decision)) =
    (SingleState(vehicle, decider, made.next), Vector(made.decision))

  def begunAnew: DecisionState = SingleState(vehicle, decider, memory.copy(held = decider.start.held))

/** Vehicles that plan together, by one search for all of them. */
private final class JointState private (
    planning: JointPlanning,
    planner: JointPlanner,
    memories: Vector[Memory],
    last: Option[PlanStage.Answer]
) extends DecisionState:
  def this(planning: JointPlanning, memories: Vector[Memory]) = this(planning, JointPlanner(), memories, None)

  export planning.{regardsTeam, vehicles}

  def decide(views: Vector[TeamView], now: Instant, slices: Vector[Int]): DecisionState.Made =
    val problem = PlanProblem(planning.planner, planning.pose(memories, views, now))
    val warm    = planner.resumed(problem, last.map(_.best))
    val found   = slices.zipWithIndex.map((count, search) => planner.searched(problem, warm, search, count))
    val answer  = PlanStage.Answer.of(found, problem, last)
    val (next, planned) = planning.decide(memories, views, now, problem.parts, answer)
    (JointState(planning, planner, next, Some(answer)), planned.map(_.decision))

  def decideBy(others: Vector[Decider], views: Vector[TeamView], now: Instant): DecisionState.Made =
    val (next, made) = others.lazyZip(memories).lazyZip(views).map(_.decideInstead(_, _, now)).unzip
    (JointState(planning, planner, next, last), made)

  /** The search then has no earlier plan to start from. */
  def begunAnew: DecisionState = JointState(planning, planner, memories, None)
