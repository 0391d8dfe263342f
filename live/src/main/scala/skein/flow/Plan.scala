package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.Flow
import scala.concurrent.Future
import skein.planning.{Objective, Planner, PlannerSettings, Situation, Plan as Found}
import skein.units.Span

/** Plans in the loop, at any time. */
object Plan:

  /** What a search came to by its deadline.
    *
    * @param best
    *   of all searches; the plan begun with where none has finished a slice
    * @param slices
    *   that each search has finished
    */
  final case class Answer(best: Found, slices: Vector[Int]):
    /** Whether there is nothing but what was left of the last plan. */
    def isMissed: Boolean = slices.forall(_ == 0)

  object Answer:
    /** The best of what several searches have found; of equals the first. */
    def of(found: Vector[Found]): Answer = Answer(found.reduce(_.orBetter(_)), found.map(_.slices))

  /** Plans upon each element: searches until the deadline from what is left of the last plan, and then decides with the
    * best found. The search never runs on the stream's thread, unless the workers are [[CountedPlanWorkers]].
    *
    * '''Emits when''' the deadline of an element is over. '''Backpressures when''' a search is under way, or downstream
    * backpressures. '''Completes when''' upstream completes and the last decision was emitted. '''Cancels when'''
    * downstream cancels.
    *
    * @param pose
    *   the situation in which to plan, and a stream of random numbers, from memory and element
    * @param decide
    *   the next memory and the decision, from memory, element, situation, and what was found
    */
  def within[M, O, D](
      deadline: Span,
      workers: PlanWorkers,
      settings: PlannerSettings,
      objective: Objective,
      start: M
  )(
      pose: (M, O) => (Situation, Long),
      decide: (M, O, Situation, Answer) => (M, D)
  )(using system: ActorSystem): Flow[O, D, NotUsed] =
    import system.dispatcher
    val planner = Planner(settings, objective)
    Flow[O]
      .scanAsync(Turn[M, D](start, planner.start, None)): (turn, element) =>
        val (situation, stream) = pose(turn.memory, element)
        val warm                = planner.resumed(turn.plan, situation.sinceDecisionS)
        val search              = workers.begin(PlanProblem(settings, objective, situation, warm, stream))
        after(deadline.toDuration, system.scheduler):
          Future:
            val answer             = Answer.of(search.finish())
            val (memory, decision) = decide(turn.memory, element, situation, answer)
            Turn(memory, answer.best, Some(decision))
      .collect(Function.unlift(_.decision))

  /** @param decision
    *   absent before the first
    */
  private final case class Turn[M, D](memory: M, plan: Found, decision: Option[D])
