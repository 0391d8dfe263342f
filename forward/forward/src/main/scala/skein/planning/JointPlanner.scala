package skein.planning

import scala.collection.mutable

/** The input of a joint planner: the vehicles' parts at one moment. */
final case class PlanProblem(settings: PlannerSettings, parts: Vector[Part]):
  require(parts.nonEmpty, "a plan is for one vehicle at least")

object PlanProblem:
  val MostSearches = 64

/** Plans for several vehicles of one controller, as an anytime algorithm. Slice by slice the vehicles take
  * turns: each improves its plan against the newest plans of all others (best responses in turn, as in
  * decentralised model predictive control; Richards and How, ''Robust distributed model predictive control'',
  * Int. J. Control 80, 2007). So no vehicle's track is guessed, and two vehicles do not evade to one side:
  * the second knows the plan of the first.
  *
  * A plan is replaced only by a better one, and a separation below the limit costs more than everything else.
  * So plans that keep apart still keep apart after a part of them was executed, even if a tick has no slice
  * for some vehicle; the next tick begins with that vehicle. This depends on how well the vehicles follow
  * [[Situation.own]].
  *
  * Equal problems, plans and numbers of slices give equal plans, to the bit. Contains the memory for blocks
  * of candidates; one per thread.
  */
final class JointPlanner:
  private val blocks   = mutable.Map.empty[Int, CandidateBlock]
  private val planners = mutable.Map.empty[(PlannerSettings, PlanCost), Planner]

  private def planner(settings: PlannerSettings, objective: PlanCost): Planner =
    planners.getOrElse((settings, objective), made(settings, objective))

  private def made(settings: PlannerSettings, objective: PlanCost): Planner =
    if blocks.size >= JointPlanner.MostBlocks then blocks.clear()
    if planners.size >= JointPlanner.MostPlanners then planners.clear()
    val block   = blocks.getOrElseUpdate(settings.steps, PlanKernel(settings.steps))
    val planner = new Planner(settings, objective, block)
    planners((settings, objective)) = planner
    planner

  /** The plan to start from: the remainder of the last plan, or straight on for all vehicles. */
  def resumed(problem: PlanProblem, last: Option[JointPlan]): JointPlan =
    val plans = problem.parts.indices.toVector.map: self =>
      val part   = problem.parts(self)
      val single = planner(problem.settings, part.objective)
      single.resumed(last.fold(single.start)(_.plans(self)), part.situation.sinceDecisionS)
    val tracks = problem.parts.zip(plans).map((part, plan) => track(problem, part, plan))
    JointPlan(plans, tracks, last.fold(0)(_.turn), 0)

  /** Improves the plan of the vehicle whose turn it is by one slice of search.
    *
    * @param search index of this search; parallel searches with different indices draw different candidates
    */
  def improved(problem: PlanProblem, plan: JointPlan, search: Int): JointPlan =
    val self = plan.turn
    val part = problem.parts(self)
    // Its cost was computed against the others' former plans; the plan itself is among the candidates.
    val before = plan.plans(self).copy(cost = Float.PositiveInfinity)
    val stream = part.stream * PlanProblem.MostSearches + search
    val better =
      planner(problem.settings, part.objective).improve(before, plan.nearSituation(self, part), stream)
    JointPlan(
      plan.plans.updated(self, better),
      plan.tracks.updated(self, track(problem, part, better)),
      (self + 1) % plan.plans.size,
      plan.slices + 1
    )

  /** Searches this number of slices, one vehicle after the other. */
  def searched(problem: PlanProblem, warm: JointPlan, search: Int, slices: Int): JointPlan =
    Iterator.iterate(warm)(improved(problem, _, search)).drop(slices).next()

  private def track(problem: PlanProblem, part: Part, plan: Plan): PredictedTrack =
    ManoeuvreRollout(part.situation, part.objective, problem.settings.dtS).track(plan.manoeuvre)

object JointPlanner:
  /** Maximum number of cached blocks, which differ in their steps; beyond it, the cache is cleared. */
  private val MostBlocks = 8

  /** Maximum number of cached planners, which differ in settings and objective. */
  private val MostPlanners = 64

  /** The best plan of several searches; of equal ones the first. Its counts of slices and candidates are
    * totals of all searches.
    */
  def best(problem: PlanProblem, found: Vector[JointPlan]): JointPlan =
    val chosen =
      if found.size == 1 then found.head else found.minBy(_.cost(problem.parts, problem.settings.dtS))
    chosen.copy(
      plans = chosen.plans.zipWithIndex.map((plan, self) =>
        plan.copy(
          slices = found.map(_.plans(self).slices).sum,
          candidates = found.map(_.plans(self).candidates).sum
        )
      ),
      slices = found.map(_.slices).sum
    )
