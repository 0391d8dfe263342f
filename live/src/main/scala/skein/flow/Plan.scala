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
    * @param unsearchedS
    *   time since any search finished a slice: 0 where one did now, infinite where none ever did
    */
  final case class Answer(best: Found, slices: Vector[Int], unsearchedS: Double):
    /** Whether there is nothing but what was left of the last plan. */
    def isMissed: Boolean = slices.forall(_ == 0)

  object Answer:
    /** The best of what several searches have found; of equals the first.
      *
      * @param last
      *   the answer before
      */
    def of(found: Vector[Found], situation: Situation, last: Option[Answer]): Answer =
      val unsearchedS =
        if found.exists(_.slices > 0) then 0.0
        else last.fold(Double.PositiveInfinity)(_.unsearchedS + situation.sinceDecisionS)
      Answer(found.reduce(_.orBetter(_)), found.map(_.slices), unsearchedS)

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
      .scanAsync(Turn[M, D](start, None, None)): (turn, element) =>
        val (situation, stream) = pose(turn.memory, element)
        val warm   = planner.resumed(turn.last.fold(planner.start)(_.best), situation.sinceDecisionS)
        val search = workers.begin(PlanProblem(settings, objective, situation, warm, stream))
        after(deadline.toDuration, system.scheduler):
          Future:
            val answer             = Answer.of(search.finish(), situation, turn.last)
            val (memory, decision) = decide(turn.memory, element, situation, answer)
            Turn(memory, Some(answer), Some(decision))
      .collect(Function.unlift(_.decision))

  /** @param last
    *   answer; it and the decision are absent before the first
    */
  private final case class Turn[M, D](memory: M, last: Option[Answer], decision: Option[D])
