package skein.link

import org.apache.pekko.stream.*
import org.apache.pekko.stream.SubscriptionWithCancelException.NonFailureCancellation
import org.apache.pekko.stream.stage.*
import org.apache.pekko.util.ByteString
import scala.collection.mutable
import skein.units.*

/** One direction of one connection over an emulated link: bytes, the end of sending and failures come out as late as
  * a [[Delivery]] decides, in order. What is due at once comes out as one segment, as from a socket.
  *
  * '''Emits when''' downstream pulls and the oldest bytes are due.
  * '''Backpressures when''' `maxBytes` or more are under way.
  * '''Completes when''' upstream has completed, everything has come out and the end of sending is due too.
  * '''Fails when''' upstream has failed and that is due, or with `broken` when the link breaks.
  * '''Cancels when''' the link breaks, or a delay after downstream has failed. A downstream that merely takes no more
  * is not told to the sender, as with a socket: what still comes is discarded until upstream ends.
  *
  * What a silence swallows is counted as lost; neither side learns of it before the link breaks.
  *
  * @param open
  *   the delivery of a line that opens at this moment
  * @param sinceStart
  *   time since the link's start
  * @param broken
  *   the error that both sides get when the link breaks
  */
private[link] final class DelayLine(
    open: Span => Delivery,
    sinceStart: () => Span,
    maxBytes: Int,
    broken: TransportError,
    counts: LineCounters
) extends GraphStage[FlowShape[ByteString, ByteString]]:
  import DelayLine.*

  private val in  = Inlet[ByteString]("DelayLine.in")
  private val out = Outlet[ByteString]("DelayLine.out")

  val shape: FlowShape[ByteString, ByteString] = FlowShape(in, out)

  def createLogic(attributes: Attributes): GraphStageLogic =
    new TimerGraphStageLogic(shape) with InHandler with OutHandler:
      private val delivery                        = open(sinceStart())
      private val underWay                        = mutable.Queue.empty[Segment]
      private var bytesUnderWay                   = 0
      private var end: Option[End]                = None
      private var cancellation: Option[Throwable] = None

      setHandlers(in, out, this)

      override def preStart(): Unit =
        delivery.breaksAt.foreach(at => scheduleOnce(Timer.Break, (at - sinceStart()).toDuration))
        pull(in)

      def onPush(): Unit =
        val bytes = grab(in)
        if isClosed(out) then pull(in)
        else
          delivery.due(sinceStart(), bytes.size) match
            case None      => counts.bytesLost.add(bytes.size)
            case Some(due) =>
              underWay.enqueue(Segment(bytes, due))
              bytesUnderWay += bytes.size
          deliver()

      override def onUpstreamFinish(): Unit = endWith(None)

      override def onUpstreamFailure(failure: Throwable): Unit = endWith(Some(failure))

      def onPull(): Unit = deliver()

      override def onDownstreamFinish(cause: Throwable): Unit =
        underWay.clear()
        bytesUnderWay = 0
        cause match
          case _ if isClosed(in)         => completeStage()
          case _: NonFailureCancellation => pullIfIdle()
          case failure                   =>
            cancellation = Some(failure)
            for due <- delivery.due(sinceStart(), 0) do
              scheduleOnce(Timer.Cancel, (due - sinceStart()).toDuration)
            pullIfIdle()

      override protected def onTimer(key: Any): Unit = key match
        case Timer.Deliver => deliver()
        case Timer.Cancel  => cancellation.foreach(cancelStage)
        case _             =>
          counts.bytesLost.add(bytesUnderWay)
          counts.onBreak()
          failStage(broken)

      private def endWith(failure: Option[Throwable]): Unit =
        if isClosed(out) then completeStage()
        else
          end = delivery.due(sinceStart(), 0).map(End(failure, _))
          deliver()

      /** Hands on what is due and sees to it that it is called again when the next is. */
      private def deliver(): Unit =
        val now = sinceStart()
        if isAvailable(out) && underWay.headOption.exists(_.due <= now) then
          val segments = underWay.removeHeadWhile(_.due <= now)
          val bytes    = segments.foldLeft(ByteString.empty)(_ ++ _.bytes)
          bytesUnderWay -= bytes.size
          counts.bytesDelivered.add(bytes.size)
          push(out, bytes)
        if bytesUnderWay < maxBytes then pullIfIdle()
        (underWay.headOption, end) match
          case (Some(segment), _)                           => if isAvailable(out) then wakeAt(segment.due)
          case (None, Some(End(failure, due))) if due > now => wakeAt(due)
          case (None, Some(End(failure, _)))                => failure.fold(completeStage())(failStage)
          case (None, None)                                 => ()

      private def wakeAt(due: Span): Unit =
        if !isTimerActive(Timer.Deliver) then scheduleOnce(Timer.Deliver, (due - sinceStart()).toDuration)

      private def pullIfIdle(): Unit = if !isClosed(in) && !hasBeenPulled(in) then pull(in)

private object DelayLine:
  private final case class Segment(bytes: ByteString, due: Span)

  /** The end of sending, with its failure if it was one. */
  private final case class End(failure: Option[Throwable], due: Span)

  private enum Timer:
    case Deliver, Cancel, Break
