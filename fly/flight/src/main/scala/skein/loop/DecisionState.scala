package skein.loop

import skein.loop.planning.PlanStage
import skein.planning.{JointPlanner, PlanProblem}
import skein.units.Instant

/** What one vehicle's decisions are made by when they are made again, with its memory. Immutable. */
private final class DecisionState(decider: Decider, memory: Memory):
  /** Whether decisions depend on more vehicles than this one and its opponent. */
  def regardsTeam: Boolean = decider.regardsTeam

  def decide(view: TeamView, now: Instant): (DecisionState, Decision) =
    val (next, decision) = decider.decide(memory, view, now)
    (DecisionState(decider, next), decision)

  /** As another would in its place, this once. */
  def decideBy(one: Decider, view: TeamView, now: Instant): (DecisionState, Decision) =
    val (next, decision) = one.decideInstead(memory, view, now)
    (DecisionState(decider, next), decision)

  /** With what the policy remembers as it was before the first decision. */
  def begunAnew: DecisionState = DecisionState(decider, memory.copy(held = decider.start.held))

/** What the decisions of vehicles that plan together are made by when they are made again. Immutable but for
  * scratch memory.
  */
private final class JointDecisionState private (
    val planning: JointPlanning,
    planner: JointPlanner,
    memories: Vector[Memory],
    last: Option[PlanStage.Answer]
):
  def this(planning: JointPlanning, memories: Vector[Memory]) = this(planning, JointPlanner(), memories, None)

  /** @param views by vehicle
    * @param slices of each search
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

  /** As others would in the planner's place, this once. */
  def decideBy(
      others: Vector[Decider],
      views: Vector[TeamView],
      now: Instant
  ): (JointDecisionState, Vector[Decision]) =
    val (next, made) = others.lazyZip(memories).lazyZip(views).map(_.decideInstead(_, _, now)).unzip
    (JointDecisionState(planning, planner, next, last), made)

  /** With no plan to go on from. */
  def begunAnew: JointDecisionState = JointDecisionState(planning, planner, memories, None)
