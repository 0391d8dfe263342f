package skein.link

import java.util.concurrent.atomic.LongAdder
import org.apache.pekko.stream.*
import org.apache.pekko.stream.SubscriptionWithCancelException.NonFailureCancellation
import org.apache.pekko.stream.stage.*
import org.apache.pekko.util.ByteString
import scala.collection.mutable
import skein.units.*

/** One direction of one connection over an emulated link: bytes, the end of sending and failures come out in
  * order, with the delay of a [[Delivery]]. Bytes that are due together come out as one segment, as from a
  * socket. Datagrams are not joined, and come out when each is due, in any order.
  *
  *   - '''Emits when''' downstream pulls and the oldest bytes are due.
  *   - '''Backpressures when''' `maxBytes` or more are in transit.
  *   - '''Completes when''' upstream has completed, everything has come out and the end of sending is due,
  *     too.
  *   - '''Fails when''' upstream has failed and that is due, or with `broken` when the link breaks.
  *   - '''Cancels when''' the link breaks, or a delay after downstream has failed. A downstream that merely
  *     cancels is not reported to the sender, as with a socket: further bytes are discarded until upstream
  *     ends.
  *
  * With a bottleneck before it, bytes enter piece by piece, as the bottleneck has room, and have its delay in
  * addition.
  *
  * Lost bytes of a stream are sent again, and later ones wait for them ([[Packets.Tcp]]). Losses do not lower
  * the rate, as they would with a congestion window.
  *
  * Bytes sent into a silence count as lost; neither side learns of it before the link breaks.
  *
  * @param open creates the delivery for a line that opens at this time
  * @param sinceStart time since the link's start
  * @param broken the error that both sides get when the link breaks
  * @param delivered counts bytes that leave the line
  */
private[link] final class DelayLine(
    open: Span => Delivery,
    bottleneck: Option[Bottleneck],
    sinceStart: () => Span,
    maxBytes: Int,
    broken: TransportError,
    counts: LinkCounters,
    delivered: LongAdder,
    onBreak: () => Unit = () => (),
    packets: Packets = Packets.Whole
) extends GraphStage[FlowShape[ByteString, ByteString]]:
  import DelayLine.*

  private val in  = Inlet[ByteString]("DelayLine.in")
  private val out = Outlet[ByteString]("DelayLine.out")

  val shape: FlowShape[ByteString, ByteString] = FlowShape(in, out)

  def createLogic(attributes: Attributes): GraphStageLogic =
    new TimerGraphStageLogic(shape) with InHandler with OutHandler:
      private val delivery      = open(sinceStart())
      private val underWay      = mutable.Queue.empty[Segment]
      private val missing       = mutable.ArrayBuffer.empty[Segment] // of those under way, the lost ones
      private val atSender      = mutable.Queue.empty[Waiting]       // for the bottleneck
      private var roomAt        = Span.Zero
      private var wakesAt       = Span.Zero
      private var repeatsAt     = Span.Zero
      private var bytesUnderWay = 0                                  // and at the sender
      private var ending: Option[Option[Throwable]] = None // once all bytes have left the sender
      private var end: Option[End]                  = None
      private var cancellation: Option[Throwable]   = None
      private val isDatagrams                       = packets.isDatagrams

      setHandlers(in, out, this)

      override def preStart(): Unit =
        delivery.breaksAt.foreach(at => scheduleOnce(Timer.Break, (at - sinceStart()).toDuration))
        pull(in)

      def onPush(): Unit =
        val bytes = grab(in)
        if isClosed(out) then pull(in)
        else
          val now     = sinceStart()
          val waiting = Waiting(bytes, now, delivery.delay(now))
          bytesUnderWay += bytes.size
          if bottleneck.isEmpty then enter(waiting, now)
          else
            atSender.enqueue(waiting)
            send(held = false)
          deliver()

      /** Takes bytes that leave their sender's side. */
      private def enter(waiting: Waiting, leave: Span): Unit = packets match
        case Packets.Whole                               => travel(waiting.bytes, leave, waiting.delay)
        case Packets.Datagrams(loss, duplicates, random) =>
          if loss.loses(leave) then
            counts.packetsLost.increment()
            lose(waiting.bytes)
          else
            travel(waiting.bytes, leave, waiting.delay)
            if duplicates > 0 && random.nextDouble() < duplicates then
              counts.duplicates.increment()
              bytesUnderWay += waiting.bytes.size
              travel(waiting.bytes, leave, delivery.delay(leave.max(sinceStart())))
        case tcp: Packets.Tcp =>
          for bytes <- Packets.of(waiting.bytes) do
            if tcp.loss.loses(leave) then
              counts.packetsLost.increment()
              val segment = Segment(bytes, Segment.Never)
              segment.lost(leave, tcp)
              underWay.enqueue(segment)
              missing += segment
            else
              travel(bytes, leave, waiting.delay)
              passed(leave, waiting.delay, tcp)
          repeatInTime()

      private def travel(bytes: ByteString, leave: Span, delay: Span): Unit =
        delivery.due(leave, delay) match
          // Anything but a datagram is due after earlier bytes.
          case Some(due) if isDatagrams =>
            underWay.insert(underWay.lastIndexWhere(_.due <= due) + 1, Segment(bytes, due))
          case Some(due) => underWay.enqueue(Segment(bytes, due))
          case None      => lose(bytes)

      private def lose(bytes: ByteString): Unit =
        bytesUnderWay -= bytes.size
        counts.bytesLost.add(bytes.size)

      /** Marks the packets whose loss the sender detects by the acknowledgement of a later packet. */
      private def passed(leave: Span, delay: Span, tcp: Packets.Tcp): Unit =
        missing.foreach(_.missed(leave, leave + delay * 2, tcp))

      private def repeat(tcp: Packets.Tcp): Unit =
        val now = sinceStart()
        for segment <- missing if segment.againAt <= now do
          counts.packetsSentAgain.increment()
          if tcp.loss.loses(now) then
            counts.packetsLost.increment()
            segment.lostAgain(now)
          else
            val delay = delivery.delay(now)
            segment.due = delivery.dueAgain(now, delay).getOrElse(Segment.Gone)
            passed(now, delay, tcp)
        missing.filterInPlace(_.isLost)
        underWay.removeAll(_.due == Segment.Gone).foreach(segment => lose(segment.bytes))
        repeatInTime()

      private def repeatInTime(): Unit =
        val next = missing.iterator.map(_.againAt).minOption
        for at <- next if !isTimerActive(Timer.Repeat) || at < repeatsAt do
          repeatsAt = at
          scheduleOnce(Timer.Repeat, (at - sinceStart()).max(Span.Zero).toDuration)

      /** Passes as many bytes to the bottleneck as it has room for.
        *
        * @param held whether there was no room before
        */
      private def send(held: Boolean): Unit =
        for line <- bottleneck do
          val now = sinceStart()
          while atSender.nonEmpty && roomAt <= now do
            val Waiting(bytes, since, delay) = atSender.dequeue()
            val (piece, rest)                =
              if isDatagrams then (bytes, ByteString.empty) else bytes.splitAt(line.pieceBytes)
            val sent = line.send(now, piece.size)
            roomAt = sent.roomAt
            if held then counts.bytesHeldBack.add(piece.size)
            counts.longestWaitNs.accumulate((sent.sentAt - since).toNanos)
            enter(Waiting(piece, since, delay), sent.sentAt)
            if rest.nonEmpty then Waiting(rest, since, delay) +=: atSender
          if atSender.nonEmpty && !isTimerActive(Timer.Send) then
            scheduleOnce(Timer.Send, (roomAt - now).toDuration)
        if atSender.isEmpty then
          for failure <- ending do
            ending = None
            end = dueWithLine().map(End(failure, _))

      /** The time at which bytes that enter now would come out if the line took no time. */
      private def dueWithLine(): Option[Span] =
        val now = sinceStart()
        delivery.due(bottleneck.fold(now)(_.free(now)), delivery.delay(now))

      override def onUpstreamFinish(): Unit = endWith(None)

      override def onUpstreamFailure(failure: Throwable): Unit = endWith(Some(failure))

      def onPull(): Unit = deliver()

      override def onDownstreamFinish(cause: Throwable): Unit =
        underWay.clear()
        missing.clear()
        atSender.clear()
        bytesUnderWay = 0
        cause match
          case _ if isClosed(in)         => completeStage()
          case _: NonFailureCancellation => pullIfIdle()
          case failure                   =>
            cancellation = Some(failure)
            for due <- dueWithLine() do
              scheduleOnce(Timer.Cancel, (due - sinceStart()).toDuration)
            pullIfIdle()

      override protected def onTimer(key: Any): Unit = key match
        case Timer.Deliver => deliver()
        case Timer.Send    =>
          send(held = true)
          deliver()
        case Timer.Repeat =>
          packets match
            case tcp: Packets.Tcp => repeat(tcp)
            case _                => ()
          deliver()
        case Timer.Cancel => cancellation.foreach(cancelStage)
        case _            =>
          counts.bytesLost.add(bytesUnderWay)
          onBreak()
          failStage(broken)

      private def endWith(failure: Option[Throwable]): Unit =
        if isClosed(out) then completeStage()
        else
          ending = Some(failure)
          send(held = false)
          deliver()

      /** Emits what is due and schedules the next delivery. */
      private def deliver(): Unit =
        val now = sinceStart()
        if isAvailable(out) && underWay.headOption.exists(_.due <= now) then
          val segments =
            if isDatagrams then Seq(underWay.dequeue()) else underWay.removeHeadWhile(_.due <= now)
          val bytes = segments.foldLeft(ByteString.empty)(_ ++ _.bytes)
          bytesUnderWay -= bytes.size
          delivered.add(bytes.size)
          push(out, bytes)
        if bytesUnderWay < maxBytes then pullIfIdle()
        (underWay.headOption, end) match
          case (Some(segment), _) => if isAvailable(out) && !segment.isLost then wakeAt(segment.due)
          case (None, Some(End(failure, due))) if due > now => wakeAt(due)
          case (None, Some(End(failure, _)))                => failure.fold(completeStage())(failStage)
          case (None, None)                                 => ()

      private def wakeAt(due: Span): Unit =
        if !isTimerActive(Timer.Deliver) || due < wakesAt then
          wakesAt = due
          scheduleOnce(Timer.Deliver, (due - sinceStart()).toDuration)

      private def pullIfIdle(): Unit = if !isClosed(in) && !hasBeenPulled(in) then pull(in)

private object DelayLine:
  /** Bytes sent at `since` that have not left yet; `delay` applies once they leave. */
  private final case class Waiting(bytes: ByteString, since: Span, delay: Span)

  /** The end of sending, with its failure if there was one. */
  private final case class End(failure: Option[Throwable], due: Span)

  private enum Timer:
    case Send, Deliver, Repeat, Cancel, Break
