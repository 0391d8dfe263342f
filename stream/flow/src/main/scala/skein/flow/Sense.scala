package skein.flow

import org.apache.pekko.actor.Cancellable
import org.apache.pekko.stream.scaladsl.Source
import scala.concurrent.Future
import skein.units.Span

/** Asks periodically and emits the answers in the order of the questions. */
object Sense:

  /** What to do with an answer that comes before the answer to an older question. */
  enum Early:
    /** Emit it at once; the older one, when it comes, is overtaken and skipped, unless it tells of a later
      * moment.
      */
    case Overtakes

    /** Keep it until the older one has come or failed, as the paper's `ask` does. */
    case Waits

  /** One question per `period`, the first after `offset`; up to `window` may be unanswered at once. An answer
    * that is an error (a timeout, most often) is skipped, so that one lost answer never stops the stream.
    *
    *   - '''Emits when''' a question is answered with a value, in order (see [[Early]]), and downstream
    *     demands.
    *   - '''Backpressures when''' never towards the clock: a tick that finds the window full, or downstream
    *     slow, is missed and counted.
    *   - '''Completes when''' the materialised `Cancellable` is cancelled and what was asked is answered.
    *   - '''Cancels when''' downstream cancels.
    *
    * @param ask must end by itself, within its own timeout
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

  /** The same at each element of `ticks`, which says how many questions were due since the last one, as
    * [[Metronome]] does. Completes when `ticks` has completed and what was asked is answered.
    *
    * @param isNewer whether the answer to an older question tells of a later moment than the answer emitted
    *   last: questions, too, overtake each other on their way
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
