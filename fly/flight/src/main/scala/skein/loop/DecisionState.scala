package skein.loop

import skein.loop.planning.PlanStage
import skein.planning.{JointPlanner, PlanProblem}
import skein.units.Instant

/** The state for repeating one vehicle's decisions, with its memory. Immutable. */
private final class DecisionState(decider: Decider, memory: Memory):
  /** Whether decisions depend on other vehicles than this one and its opponent. */
  def regardsTeam: Boolean = decider.regardsTeam

  def decide(view: TeamView, now: Instant): (DecisionState, Decision) =
    val (next, decision) = decider.decide(memory, view, now)
    (DecisionState(decider, next), decision)

  def decideBy(one: Decider, view: TeamView, now: Instant): (DecisionState, Decision) =
    val (next, decision) = one.decideInstead(memory, view, now)
    (DecisionState(decider, next), decision)

  /** This state with the policy's memory as before the first decision. */
  def begunAnew: DecisionState = DecisionState(decider, memory.copy(held = decider.start.held))

/** The state for repeating decisions of vehicles that plan together. Immutable except for scratch memory. */
private final class JointDecisionState private (
    val planning: JointPlanning,
    planner: JointPlanner,
    memories: Vector[Memory],
    last: Option[PlanStage.Answer]
):
  def this(planning: JointPlanning, memories: Vector[Memory]) = this(planning, JointPlanner(), memories, None)

  /** Repeats a joint decision.
    *
    * @param views a view for each vehicle
    * @param slices number of slices of each search
    */
  def decide(
      views: Vector[TeamView],
      now: Instant,
      slices: Vector[Int]
  ): (JointDecisionState, Vector[Decision]) =
    val problem = PlanProblem(planning.planner, planning.pose(memories, views, now))
    val warm    = planner.resumed(problem, last.map(_.best))
    val found   = slices.zipWithIndex.map((count, search) => planner.searched(problem, warm, search, count))
    val answer  = PlanStage.Answer.of(found, problem, last)
    val (next, planned) = planning.decide(memories, views, now, problem.parts, answer)
    (JointDecisionState(planning, planner, next, Some(answer)), planned.map(_.decision))

  /** Decides once by others instead of the planner. */
  def decideBy(
      others: Vector[Decider],
      views: Vector[TeamView],
      now: Instant
  ): (JointDecisionState, Vector[Decision]) =
    val (next, made) = others.lazyZip(memories).lazyZip(views).map(_.decideInstead(_, _, now)).unzip
    (JointDecisionState(planning, planner, next, last), made)

  /** The state without an earlier plan to start from. */
  def begunAnew: JointDecisionState = JointDecisionState(planning, planner, memories, None)
