package skein.loop.planning

import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.Flow
import scala.concurrent.{ExecutionContext, Future}
import skein.planning.{JointPlan, JointPlanner, Part, PlanProblem, PlannerSettings}
import skein.units.Span

/** Plans in the loop, at any time. */
object PlanStage:

  /** What a search came to by its deadline.
    *
    * @param best of all searches; the plans begun with where none has finished a slice
    * @param slices that each search has finished
    * @param unsearchedS by vehicle, time since any search finished a slice for it: 0 where one did now,
    *   infinite where none ever did
    */
  final case class Answer(best: JointPlan, slices: Vector[Int], unsearchedS: Vector[Double]):
    /** Whether there is nothing for a vehicle but what was left of its last plan. */
    def isMissed(vehicle: Int): Boolean = best.plans(vehicle).slices == 0

  object Answer:
    /** The best of what several searches have found.
      *
      * @param last the answer before
      */
    def of(found: Vector[JointPlan], problem: PlanProblem, last: Option[Answer]): Answer =
      val best        = JointPlanner.best(problem, found)
      val unsearchedS = problem.parts.indices.toVector.map: vehicle =>
        if best.plans(vehicle).slices > 0 then 0.0
        else
          last.fold(Double.PositiveInfinity)(
            _.unsearchedS(vehicle) + problem.parts(vehicle).situation.sinceDecisionS
          )
      Answer(best, found.map(_.slices), unsearchedS)

  /** Searches until the deadline from what is left of the last plans, by the workers.
    *
    * @param planner of whoever asks, who waits for one search before the next
    */
  def searched(
      problem: PlanProblem,
      last: Option[Answer],
      deadline: Span,
      workers: PlanWorkers,
      planner: JointPlanner
  )(using system: ActorSystem): Future[Answer] =
    import system.dispatcher
    val search = workers.begin(problem, planner.resumed(problem, last.map(_.best)))
    after(deadline.toDuration, system.scheduler)(Future(Answer.of(search.finish(), problem, last)))

  /** Plans upon each element for several vehicles together, or for one: searches until the deadline from what
    * is left of the last plans, and then decides with the best found. The search never runs on the stream's
    * thread, unless the workers are [[CountedPlanWorkers]].
    *
    * '''Emits when''' the deadline of an element is over. '''Backpressures when''' a search is under way, or
    * downstream backpressures. '''Completes when''' upstream completes and the last decision was emitted.
    * '''Cancels when''' downstream cancels.
    *
    * @param pose what to plan for, from memory and element: always the same vehicles
    * @param decide the next memory and the decision, from memory, element, what was planned for, and what was
    *   found
    */
  def within[M, O, D](
      deadline: Span,
      workers: PlanWorkers,
      settings: PlannerSettings,
      start: M
  )(
      pose: (M, O) => Vector[Part],
      decide: (M, O, Vector[Part], Answer) => (M, D)
  )(using system: ActorSystem): Flow[O, D, NotUsed] =
    given ExecutionContext = ExecutionContext.parasitic
    val planner            = JointPlanner()
    Flow[O]
      .scanAsync(Turn[M, D](start, None, None)): (turn, element) =>
        val problem = PlanProblem(settings, pose(turn.memory, element))
        searched(problem, turn.last, deadline, workers, planner).map: answer =>
          val (memory, decision) = decide(turn.memory, element, problem.parts, answer)
          Turn(memory, Some(answer), Some(decision))
      .collect(Function.unlift(_.decision))

  /** @param last answer; it and the decision are absent before the first
    */
  private final case class Turn[M, D](memory: M, last: Option[Answer], decision: Option[D])
