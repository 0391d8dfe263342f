package skein.loop

import skein.flow.{Plan, PlanProblem, Planners}
import skein.record.Decision
import skein.units.Instant

/** What one vehicle's decisions are made by when they are made again, with its memory. Immutable but for scratch memory.
  */
private trait Mind:
  /** Whether decisions depend on more vehicles than this one and its opponent. */
  def regardsTeam: Boolean

  /** Whether decisions are searched for. */
  def searches: Boolean

  /** @param slices
    *   of each search
    */
  def decide(picture: Picture, now: Instant, slices: Vector[Int]): (Mind, Decision)

private object Mind:

  final class Deciding(decider: Decider, memory: Memory) extends Mind:
    def regardsTeam: Boolean = decider.regardsTeam
    def searches: Boolean    = false

    def decide(picture: Picture, now: Instant, slices: Vector[Int]): (Mind, Decision) =
      decideBy(decider, picture, now)

    /** As another would in its place, this once. */
    def decideBy(one: Decider, picture: Picture, now: Instant): (Mind, Decision) =
      val (next, decision) = one.decide(memory, picture, now)
      (Deciding(decider, next), decision)

  final class Searching(planning: Planning, planners: Planners, memory: Memory, last: Option[Plan.Answer])
      extends Mind:
    def this(planning: Planning, memory: Memory) = this(planning, Planners(), memory, None)

    def regardsTeam: Boolean = planning.regardsTeam
    def searches: Boolean    = true

    def decide(picture: Picture, now: Instant, slices: Vector[Int]): (Mind, Decision) =
      val (situation, stream) = planning.pose(memory, picture, now)
      val planner             = planners.of(planning.planner, planning.objective)
      val warm                = planner.resumed(last.fold(planner.start)(_.best), situation.sinceDecisionS)
      val problem             = PlanProblem(planning.planner, planning.objective, situation, warm, stream)
      val found  = slices.zipWithIndex.map((count, search) => planners.searched(problem, search, count))
      val answer = Plan.Answer.of(found, situation, last)
      val (next, planned) = planning.decide(memory, picture, now, situation, answer)
      (Searching(planning, planners, next, Some(answer)), planned.decision)
