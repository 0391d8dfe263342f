package skein.flow

import org.apache.pekko.actor.Cancellable
import org.apache.pekko.stream.scaladsl.Source
import scala.concurrent.Future
import skein.units.Span

/** Sends requests periodically and emits the answers in the order of the requests. */
object Sense:

  /** The treatment of an answer that arrives before the answer to an older request. */
  enum Early:
    /** Emit it immediately. The older request's answer is skipped as overtaken when it arrives, unless it is
      * valid at a later time.
      */
    case Overtakes

    /** Keep it until the older request is answered or has failed, as the paper's `ask` does. */
    case Waits

  /** Sends one request per `period`, the first after `offset`; up to `window` may be unanswered at a time. An
    * answer that is an error (a timeout, most often) is skipped, so that one lost answer never stops the
    * stream.
    *
    *   - '''Emits when''' a request is answered with a value, in order (see [[Early]]), and downstream
    *     demands.
    *   - '''Backpressures when''' never towards the clock: a tick that finds the window full, or downstream
    *     slow, is missed and counted.
    *   - '''Completes when''' the materialised `Cancellable` is cancelled and all requests are answered.
    *   - '''Cancels when''' downstream cancels.
    *
    * @param ask sends one request; must complete within its own timeout
    * @param onSkip called for every answer skipped: the error, or the value overtaken
    * @param onMissed called with the number of ticks that were missed
    */
  def every[E, A](period: Span, offset: Span = Span.Zero, window: Int = 4, early: Early = Early.Overtakes)(
      ask: () => Future[Either[E, A]]
  )(onSkip: Either[E, A] => Unit, onMissed: Int => Unit): Source[A, Cancellable] =
    at(
      Source.tick(offset.toDuration, period.toDuration, 1).conflate(_ + _),
      window,
      early
    )(ask)(onSkip, onMissed)

  /** Sends a request at each element of `ticks`, which is the number of requests due since the last element,
    * as [[Metronome]] emits it. Completes when `ticks` has completed and all requests are answered.
    *
    * @param isNewer whether the answer to an older request is valid at a later time than the last emitted
    *   answer: requests may overtake each other, too
    */
  def at[E, A, M](
      ticks: Source[Int, M],
      window: Int = 4,
      early: Early = Early.Overtakes,
      isNewer: (A, A) => Boolean = (_: A, _: A) => false
  )(
      ask: () => Future[Either[E, A]]
  )(onSkip: Either[E, A] => Unit, onMissed: Int => Unit): Source[A, M] =
    val questions = ticks
      .map(ticks => if ticks > 1 then onMissed(ticks - 1))
      .zipWithIndex
      .map(_._2)
    def answer(question: Long) = ask().map((question, _))(using scala.concurrent.ExecutionContext.parasitic)
    val answers                = early match
      case Early.Overtakes => questions.mapAsyncUnordered(window)(answer)
      case Early.Waits     => questions.mapAsync(window)(answer)
    answers
      .statefulMap(() => Option.empty[(Long, A)])(
        (newest, answer) =>
          answer match
            case (question, Right(value))
                if newest.forall((last, held) => question > last || isNewer(value, held)) =>
              (Some((newest.fold(question)(_._1.max(question)), value)), Some(value))
            case (_, unusable) =>
              onSkip(unusable)
              (newest, None)
        ,
        _ => None
      )
      .collect { case Some(value) => value }
