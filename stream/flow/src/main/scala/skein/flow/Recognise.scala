package skein.flow

import org.apache.pekko.stream.stage.*
import org.apache.pekko.stream.{Attributes, FlowShape, Inlet, Outlet}
import scala.collection.mutable
import scala.concurrent.{ExecutionContext, Future}
import scala.util.control.NonFatal
import scala.util.{Failure, Success, Try}
import skein.signal.Stamped
import skein.units.*

/** The result of recognition in a frame.
  *
  * @param found the result with the frame's times: valid at the frame's exposure
  * @param startedAt time at which recognition began, on the controller's clock
  * @param took duration of the recognition
  */
final case class Recognised[+B](found: Stamped[B], startedAt: Instant, took: Span)

/** The reasons why a frame has no result. */
enum Unrecognised[+A]:
  /** Recognition had not ended at its deadline. */
  case Late(frame: Stamped[A])

  case Failed(frame: Stamped[A], cause: Throwable)

  /** Another frame with a later exposure was started or emitted first. */
  case Overtaken(frame: Stamped[A])

/** Runs recognition on several frames at a time: the next frame is started before the last is done.
  *
  * A late worker continues and gets no new frame until it has ended, so at most `workers` frames are in
  * progress. A worker that never ends is lost.
  *
  *   - '''Emits when''' a frame's recognition has ended in time and downstream demands: in the order of
  *     exposure, once all frames before it have ended or are late; or, with `newestFirst`, immediately, and
  *     frames with earlier exposures are not emitted.
  *   - '''Backpressures when''' all workers are busy, or twice as many frames wait to be emitted.
  *   - '''Completes when''' upstream has completed and every frame has been emitted or skipped.
  *   - '''Cancels when''' downstream cancels.
  *
  * @param workers maximum number of frames in progress at a time
  * @param isNewer whether one frame was exposed later than another; if the simulator may restart, use
  *   [[skein.signal.ClockAlignment.isNewer]]
  * @param deadline maximum duration of each frame's recognition
  * @param recognise begins work on a frame. Calls with equal `worker`, from 0, never overlap, so each worker
  *   may have an object that is not thread-safe. The future must complete by itself, and the work must not be
  *   done on the caller's thread
  * @param onSkip called for every frame without an emitted result
  */
final class Recognise[A, B](
    workers: Int,
    deadline: Span,
    clock: Clock,
    newestFirst: Boolean = false,
    isNewer: (Stamped[?], Stamped[?]) => Boolean = _.isNewerThan(_)
)(
    recognise: (worker: Int, frame: Stamped[A]) => Future[B]
)(onSkip: Unrecognised[A] => Unit)
    extends GraphStage[FlowShape[Stamped[A], Recognised[B]]]:
  require(
    workers > 0 && deadline > Span.Zero,
    s"recognition needs workers and time: $workers, ${deadline.toMillis} ms"
  )

  private val in  = Inlet[Stamped[A]]("Recognise.in")
  private val out = Outlet[Recognised[B]]("Recognise.out")

  val shape: FlowShape[Stamped[A], Recognised[B]] = FlowShape(in, out)

  /** A frame in progress, begun and not yet emitted or skipped. */
  private final class Begun(val frame: Stamped[A], val worker: Int, val startedAt: Instant):
    var result: Option[Recognised[B]] = None

  def createLogic(attributes: Attributes): GraphStageLogic =
    new TimerGraphStageLogic(shape) with InHandler with OutHandler:
      private val idle     = mutable.Queue.from(0 until workers)
      private val line     = mutable.ArrayDeque.empty[Begun] // in order of exposure
      private var lastSeen = Option.empty[Stamped[A]]
      private val ended    = getAsyncCallback[(Begun, Try[B])](onEnded)

      setHandlers(in, out, this)

      override def preStart(): Unit = pull(in)

      def onPush(): Unit =
        val frame = grab(in)
        if lastSeen.exists(!isNewer(frame, _)) then onSkip(Unrecognised.Overtaken(frame))
        else
          lastSeen = Some(frame)
          begin(frame)
        settle()

      def onPull(): Unit = settle()

      override def onUpstreamFinish(): Unit = settle()

      override protected def onTimer(key: Any): Unit = key match
        case late: Begun @unchecked =>
          line -= late
          onSkip(Unrecognised.Late(late.frame))
          settle()

      private def begin(frame: Stamped[A]): Unit =
        val begun = Begun(frame, idle.dequeue(), clock.now())
        line += begun
        scheduleOnce(begun, deadline.toDuration)
        val work =
          try recognise(begun.worker, frame)
          catch case NonFatal(cause) => Future.failed(cause)
        work.onComplete(result => ended.invoke((begun, result)))(using ExecutionContext.parasitic)

      private def onEnded(begun: Begun, result: Try[B]): Unit =
        idle.enqueue(begun.worker)
        if line.contains(begun) then
          cancelTimer(begun)
          result match
            case Success(found) =>
              begun.result = Some(
                Recognised(begun.frame.map(_ => found), begun.startedAt, clock.now().since(begun.startedAt))
              )
            case Failure(cause) =>
              line -= begun
              onSkip(Unrecognised.Failed(begun.frame, cause))
        settle()

      private def settle(): Unit =
        if newestFirst then
          val newest = line.lastIndexWhere(_.result.isDefined)
          for _ <- 0 until newest do skip(line.removeHead())
        if isAvailable(out) then
          for head <- line.headOption; result <- head.result do
            line.removeHead(): Unit
            push(out, result)
        if isClosed(in) then { if line.isEmpty then completeStage() }
        else if idle.nonEmpty && line.sizeIs < 2 * workers && !hasBeenPulled(in) then pull(in)

      /** Skips a frame that a later exposure has overtaken. */
      private def skip(begun: Begun): Unit =
        cancelTimer(begun)
        onSkip(Unrecognised.Overtaken(begun.frame))

object Recognise:

  /** Runs recognition functions on threads: one worker for each function. A function is never called
    * concurrently.
    *
    * @param threads threads to run on; at least as many as functions, and not those of the streams
    */
  def by[A, B](functions: IndexedSeq[A => B], threads: ExecutionContext)(
      worker: Int,
      frame: Stamped[A]
  ): Future[B] = Future(functions(worker)(frame.value))(using threads)
