package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.Flow
import scala.concurrent.Future
import scala.util.{Failure, Success, Try}
import skein.units.Span

/** Runs policies as stages of a stream. */
object Decide:

  /** Runs a policy that has a memory. `policy(memory, observation)` gives the next memory and the decision;
    * it is a pure function, called once per observation in the order of arrival.
    *
    * '''Emits when''' an observation arrives. '''Backpressures when''' downstream backpressures. '''Completes
    * when''' upstream completes. '''Cancels when''' downstream cancels.
    */
  def withMemory[M, O, D](start: M)(policy: (M, O) => (M, D)): Flow[O, D, NotUsed] =
    Flow[O].statefulMap(() => start)(policy, _ => None)

  /** Runs a slow policy, such as a search or another process, and waits for it at most `deadline`. One call
    * is in progress at a time: while the policy is late, observations are decided by `otherwise` immediately.
    * A late answer is discarded together with its memory.
    *
    * '''Emits when''' the policy decides, or its deadline has passed. '''Backpressures when''' a decision is
    * in progress, or downstream backpressures. '''Completes when''' upstream completes and the last decision
    * was emitted. '''Cancels when''' downstream cancels.
    *
    * @param asksAgain whether a late policy is called again at every observation, as suits a policy that
    *   abandons an older observation for a newer one
    */
  def within[M, O, D](deadline: Span, otherwise: OnOverrun[M, O, D], start: M, asksAgain: Boolean = false)(
      policy: (M, O) => Future[(M, D)]
  )(using system: ActorSystem): Flow[O, DeadlineResult[D], NotUsed] =
    import system.dispatcher

    def answer(working: Future[Any], ask: => Future[(M, D)]): (Future[Any], Future[Either[Overrun, (M, D)]]) =
      if !asksAgain && !working.isCompleted then (working, Future.successful(Left(Overrun.Busy)))
      else
        val asked   = Try(ask).fold(Future.failed, identity)
        val decided = asked.transform:
          case Success(decision) => Success(Right(decision))
          case Failure(cause)    => Success(Left(Overrun.Failed(cause)))
        val late = after(deadline.toDuration, system.scheduler)(Future.successful(Left(Overrun.Late)))
        (asked, Future.firstCompletedOf(Seq(decided, late)))

    Flow[O]
      .scanAsync(Turn[M, D](start, None, Future.unit, None)): (turn, observation) =>
        val (working, answered) = answer(turn.working, policy(turn.memory, observation))
        answered.map(turn.next(working, observation, _, otherwise))
      .collect(Function.unlift(_.result))

  /** @param working completes when the policy may be called again
    * @param result the result of this turn; None before the first
    */
  private final case class Turn[M, D](
      memory: M,
      last: Option[D],
      working: Future[Any],
      result: Option[DeadlineResult[D]]
  ):
    def next[O](
        working: Future[Any],
        observation: O,
        answer: Either[Overrun, (M, D)],
        otherwise: OnOverrun[M, O, D]
    ): Turn[M, D] = answer match
      case Right((memory, decision)) =>
        Turn(memory, Some(decision), working, Some(DeadlineResult.Decided(decision)))
      case Left(miss) =>
        val (kept, instead) = otherwise match
          case OnOverrun.Hold()      => (memory, None)
          case OnOverrun.Repeat()    => (memory, last)
          case OnOverrun.Ask(policy) =>
            val (memory, decision) = policy(this.memory, observation)
            (memory, Some(decision))
        Turn(kept, instead.orElse(last), working, Some(DeadlineResult.Missed(miss, instead)))
