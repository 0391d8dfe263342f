package skein.flow

import org.apache.pekko.stream.stage.*
import org.apache.pekko.stream.{Attributes, FlowShape, Inlet, Outlet}
import scala.collection.mutable
import scala.concurrent.{ExecutionContext, Future}
import scala.util.control.NonFatal
import scala.util.{Failure, Success, Try}
import skein.signal.Stamped
import skein.units.*

/** What was found in a frame.
  *
  * @param found
  *   with the frame's times: it was so when the frame was exposed
  * @param startedAt
  *   when recognition began, on the controller's clock
  * @param took
  *   how long it lasted
  */
final case class Recognised[+B](found: Stamped[B], startedAt: Instant, took: Span)

/** Why nothing is known of a frame. */
enum Unrecognised[+A]:
  /** Recognition had not ended at its deadline. */
  case Late(frame: Stamped[A])

  /** It failed. */
  case Failed(frame: Stamped[A], cause: Throwable)

  /** A later exposure was begun or emitted before it. */
  case Overtaken(frame: Stamped[A])

/** Looks for something in frames, several at a time: the next one is begun before the last is done. Control never waits
  * for it.
  *
  * A worker that is late works on and is given nothing meanwhile, so never more than `workers` frames are worked on. A
  * worker that never ends is lost.
  *
  * '''Emits when''' a frame's recognition has ended in time and downstream demands: in the order of exposure, once all
  * frames before it have ended or are late; or, `newestFirst`, at once, and what was exposed before it is no more emitted.
  * '''Backpressures when''' all workers work, or twice as many frames wait to be emitted.
  * '''Completes when''' upstream has completed and every frame has been emitted or skipped.
  * '''Cancels when''' downstream cancels.
  *
  * @param workers
  *   at work at the same time
  * @param isNewer
  *   whether one frame is of a later moment than another: over a restart of the simulator
  *   [[skein.signal.ClockAlignment.isNewer]] knows better than two frames alone
  * @param deadline
  *   of each frame, from when it is begun
  * @param recognise
  *   begins work on a frame; `worker`, from 0, is not at work meanwhile, so what is not thread-safe may be kept for each.
  *   It must end by itself and must not do the work on the caller's thread
  * @param onSkip
  *   told of every frame of which nothing is emitted
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

  /** A frame that was begun and not yet emitted or skipped. */
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

      /** A later exposure has ended before it. */
      private def skip(begun: Begun): Unit =
        cancelTimer(begun)
        onSkip(Unrecognised.Overtaken(begun.frame))

object Recognise:

  /** Recognition by functions that work on a thread until they are done: one worker for each. A function is never called
    * by two threads at once.
    *
    * @param threads
    *   where they work; at least as many as functions, and not those of the streams
    */
  def by[A, B](functions: IndexedSeq[A => B], threads: ExecutionContext)(
      worker: Int,
      frame: Stamped[A]
  ): Future[B] = Future(functions(worker)(frame.value))(using threads)
