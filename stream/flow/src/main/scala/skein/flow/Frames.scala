package skein.flow

import org.apache.pekko.stream.scaladsl.{Flow, Source}
import scala.concurrent.Future
import skein.signal.Stamped

/** A camera or a lidar as a source of frames, each with its exposure time. */
object Frames:

  /** The reasons why a frame was not emitted. */
  enum Skipped[+E, +A]:
    /** This many frames were due while `inFlight` requested frames had not arrived. */
    case Missed(frames: Int)

    case Failed(error: E)

    /** A frame with a later exposure arrived before it. */
    case Overtaken(frame: Stamped[A])

    /** The sensor returned its previous exposure again. */
    case Repeated(frame: Stamped[A])

    /** A newer frame arrived before downstream demanded this one. */
    case Replaced(frame: Stamped[A])

  /** Requests a frame at each element of `ticks`, which is the number of frames due since the last element,
    * as [[Metronome]] emits it. A frame's `validAt` is its exposure; every emitted frame is newer than the
    * one before. A failed request never stops the source.
    *
    *   - '''Emits when''' a frame has arrived that is newer than all before and downstream demands.
    *   - '''Backpressures when''' never: while downstream is slow, the newest frame replaces the waiting one.
    *   - '''Completes when''' `ticks` has completed and all requested frames have arrived.
    *   - '''Cancels when''' downstream cancels.
    *
    * @param inFlight maximum number of requested frames that have not arrived
    * @param isNewer whether one frame was exposed later than another: across a restart of the simulator,
    *   [[skein.signal.ClockAlignment.isNewer]] is more reliable than two frames alone
    * @param ask requests one frame; must complete within its own timeout
    * @param onSkip called for every frame that was due and is not emitted
    */
  def at[E, A, M](
      ticks: Source[Int, M],
      inFlight: Int = 2,
      isNewer: (Stamped[?], Stamped[?]) => Boolean = _.isNewerThan(_)
  )(
      ask: () => Future[Either[E, Stamped[A]]]
  )(onSkip: Skipped[E, A] => Unit): Source[Stamped[A], M] =
    Sense
      .at(ticks, inFlight, isNewer = (frame: Stamped[A], held: Stamped[A]) => isNewer(frame, held))(ask)(
        {
          case Left(error)  => onSkip(Skipped.Failed(error))
          case Right(frame) => onSkip(Skipped.Overtaken(frame))
        },
        missed => onSkip(Skipped.Missed(missed))
      )
      .via(newerOnly(
        isNewer,
        frame => onSkip(Skipped.Repeated(frame)),
        frame => onSkip(Skipped.Overtaken(frame))
      ))
      .via(Newest(frame => onSkip(Skipped.Replaced(frame))))

  private def newerOnly[A](
      isNewer: (Stamped[?], Stamped[?]) => Boolean,
      onRepeated: Stamped[A] => Unit,
      onOlder: Stamped[A] => Unit
  ) =
    Flow[Stamped[A]]
      .statefulMap(() => Option.empty[Stamped[A]])(
        (last, frame) =>
          if last.exists(_.validAt == frame.validAt) then
            onRepeated(frame)
            (last, None)
          else if last.forall(isNewer(frame, _)) then (Some(frame), Some(frame))
          else
            onOlder(frame)
            (last, None)
        ,
        _ => None
      )
      .collect { case Some(frame) => frame }
