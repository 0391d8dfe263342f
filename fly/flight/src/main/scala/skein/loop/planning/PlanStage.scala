package skein.loop.planning

import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.Flow
import scala.concurrent.{ExecutionContext, Future}
import skein.planning.{JointPlan, JointPlanner, Part, PlanProblem, PlannerSettings}
import skein.units.Span

/** A stage that plans within a deadline, by an anytime search. */
object PlanStage:

  /** The result of a search at its deadline.
    *
    * @param best the best plans of all searches; the initial plans if none has finished a slice
    * @param slices number of slices that each search has finished
    * @param unsearchedS for each vehicle, time since any search finished a slice for it: 0 if one did now,
    *   infinite if none ever did
    */
  final case class Answer(best: JointPlan, slices: Vector[Int], unsearchedS: Vector[Double]):
    /** Whether no search finished a slice for a vehicle: its plan is then the remainder of its last one. */
    def isMissed(vehicle: Int): Boolean = best.plans(vehicle).slices == 0

  object Answer:
    /** The best result of several searches.
      *
      * @param last the previous result
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

  /** Searches until the deadline from the remainder of the last plans, by the workers.
    *
    * @param planner the caller's planner; the caller waits for one search before the next
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

  /** Plans on each element for several vehicles jointly, or for one: searches until the deadline from the
    * remainder of the last plans, and then decides by the best found. The search never runs on the stream's
    * thread, unless the workers are [[CountedPlanWorkers]].
    *
    * '''Emits when''' the deadline of an element has passed. '''Backpressures when''' a search is in
    * progress, or downstream backpressures. '''Completes when''' upstream completes and the last decision was
    * emitted. '''Cancels when''' downstream cancels.
    *
    * @param pose the planning problem, from memory and element: for a constant set of vehicles
    * @param decide the next memory and the decision, from memory, element, problem and result
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

  /** State between elements.
    *
    * @param last the last result; it and the decision are absent before the first
    */
  private final case class Turn[M, D](memory: M, last: Option[Answer], decision: Option[D])
