package skein.loop

import skein.loop.planning.Plan
import skein.planning.{JointPlanner, PlanProblem}
import skein.units.Instant

/** What one vehicle's decisions are made by when they are made again, with its memory. Immutable. */
private final class Mind(decider: Decider, memory: Memory):
  /** Whether decisions depend on more vehicles than this one and its opponent. */
  def regardsTeam: Boolean = decider.regardsTeam

  def decide(picture: Picture, now: Instant): (Mind, Decision) = decideBy(decider, picture, now)

  /** As another would in its place, this once. */
  def decideBy(one: Decider, picture: Picture, now: Instant): (Mind, Decision) =
    val (next, decision) = one.decide(memory, picture, now)
    (Mind(decider, next), decision)

/** What the decisions of vehicles that plan together are made by when they are made again. Immutable but for scratch
  * memory.
  */
private final class JointMind private (
    val planning: JointPlanning,
    planner: JointPlanner,
    memories: Vector[Memory],
    last: Option[Plan.Answer]
):
  def this(planning: JointPlanning, memories: Vector[Memory]) = this(planning, JointPlanner(), memories, None)

  /** @param pictures
    *   by vehicle
    * @param slices
    *   of each search
    */
  def decide(pictures: Vector[Picture], now: Instant, slices: Vector[Int]): (JointMind, Vector[Decision]) =
    val problem = PlanProblem(planning.planner, planning.pose(memories, pictures, now))
    val warm    = planner.resumed(problem, last.map(_.best))
    val found   = slices.zipWithIndex.map((count, search) => planner.searched(problem, warm, search, count))
    val answer  = Plan.Answer.of(found, problem, last)
    val (next, planned) = planning.decide(memories, pictures, now, problem.parts, answer)
    (JointMind(planning, planner, next, Some(answer)), planned.map(_.decision))
