package skein.rpc

import java.util.concurrent.ConcurrentLinkedQueue
import java.util.concurrent.atomic.AtomicBoolean
import org.apache.pekko.stream.stage.*
import org.apache.pekko.stream.{Attributes, FlowShape, Inlet, Outlet}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future}
import scala.util.control.NonFatal
import scala.util.{Failure, Success, Try}
import skein.link.{FirstBytes, Places}
import skein.units.*
import upack.Msg

/** Serves one connection: takes the bytes of requests and emits the bytes of replies, in the order of their
  * completion.
  *
  *   - '''Emits when''' replies are ready; those ready together leave together.
  *   - '''Backpressures when''' its limit of requests in progress, of reply bytes not yet taken, or of memory
  *     held is reached. A request too large for the memory left waits for its connection's requests in
  *     progress; then, or after the longest time for a message, it is answered with an error, and so is one
  *     whose reply is too large.
  *   - '''Completes when''' upstream has completed and every request is answered, or immediately on malformed
  *     input or a limit that waiting cannot relieve.
  *   - '''Cancels when''' downstream cancels, or on malformed input or such a limit.
  */
private[rpc] final class ServerConnection(
    connection: Long,
    limits: ServerLimits,
    handler: RpcHandler,
    counters: ServerCounters,
    holdings: Holdings,
    turns: Holdings,
    places: Places,
    observe: ServerEvent => Unit
) extends GraphStage[FlowShape[ByteString, ByteString]]:
  import ServerConnection.*

  private val in  = Inlet[ByteString]("requests")
  private val out = Outlet[ByteString]("replies")

  override val shape: FlowShape[ByteString, ByteString] = FlowShape(in, out)

  override def createLogic(inherited: Attributes): GraphStageLogic =
    new TimerGraphStageLogic(shape) with InHandler with OutHandler with Places.Guest:
      private val framer    = Framer(limits.frame)
      private val writer    = MessageWriter()
      private val patience  = Patience(limits)
      private val done      = ConcurrentLinkedQueue[Outcome]()
      private val scheduled = AtomicBoolean()
      private val wake      = getAsyncCallback[Unit](_ => collect())
      private val leaving   = getAsyncCallback[Unit](_ => close(ServerLimit.Idle, "its place was needed"))
      private var inFlight  = 0
      private var consumed  = true // every value of the last segment is taken
      private var strays    = 0    // values since the last request that were no messages
      private var reason    = Option.empty[String]

      @volatile private var spoken   = false // a request has been received
      @volatile private var finished = false // the peer sends no more

      // The next message, while it exceeds the memory left, and the number of watches since then.
      private var heldBack = Option.empty[Array[Byte]]
      private var backFor  = 0

      // The memory that it holds, bytes.
      private val holding = holdings.Holding()
      private var segment = 0  // of the last segment, while it is not consumed
      private var inHand  = 0L // of requests being handled
      private var sending = 0  // of replies handed downstream, until it pulls

      // Requests that it may have in flight.
      private val turn = turns.Holding()

      setHandlers(in, out, this)

      override def preStart(): Unit =
        places.entered(connection, this)
        scheduleOnce(Watch, ServerLimits.Watch.toDuration)
        pull(in)

      override def onPush(): Unit =
        val bytes = grab(in)
        patience.came()
        foreign(bytes) match
          case Some(what) =>
            close(ServerLimit.Malformed, s"expected a message of MessagePack-RPC, got $what")
          case None =>
            framer.offer(bytes)
            segment = bytes.length
            consumed = false
            proceed()

      /** The protocol that a peer speaks instead of MessagePack-RPC, recognised by its first byte. */
      private def foreign(bytes: ByteString): Option[String] =
        if spoken || framer.midway then None
        else
          FirstBytes.verdict(bytes, Starts) match
            case FirstBytes.Foreign(what) => Some(what)
            case _                        => None

      override def onPull(): Unit =
        sending = 0
        patience.taken()
        proceed()

      override def onUpstreamFinish(): Unit =
        finished = true
        observe(ServerEvent.Finished(connection))
        proceed()

      override def onUpstreamFailure(failure: Throwable): Unit =
        reason = Some(Option(failure.getMessage).getOrElse(failure.toString))
        failStage(failure)

      override def postStop(): Unit =
        holding.force(0)
        turn.force(0)
        places.left(connection)
        observe(ServerEvent.Closed(connection, reason))

      def hasSpoken: Boolean = spoken

      def silentFor: Span = if finished then limits.idle else patience.silentFor

      def leave(): Unit = leaving.invoke(())

      override protected def onTimer(key: Any): Unit =
        val nothing = inFlight == 0 && sending == 0 && !framer.midway
        patience.watch(consumed && framer.midway, sending > 0, nothing) match
          case Some((limit, why)) => close(limit, why)
          case None               =>
            scheduleOnce(Watch, ServerLimits.Watch.toDuration)
            if heldBack.nonEmpty then backFor += 1
            proceed()

      private def close(limit: ServerLimit, why: String): Unit =
        refuse(limit, why)
        completeStage()

      private def refuse(limit: ServerLimit, why: String): Unit =
        counters.limited(limit)
        reason = Some(why)

      /** Takes requests within the limits, and sends what is ready. */
      private def proceed(): Unit =
        try
          takeRequests()
          if isAvailable(out) && writer.length > 0 then
            sending = writer.length
            push(out, writer.take())
            takeRequests()
          if reason.nonEmpty then completeStage()
          else if consumed then
            if !isClosed(in) then
              if !hasBeenPulled(in) && mayRead then pull(in)
            else if inFlight == 0 && writer.length == 0 then
              if framer.midway then reason = Some("the peer stopped in the middle of a message")
              completeStage()
        catch
          case NonFatal(failure) =>
            reason = Some(s"serving it failed: $failure")
            failStage(failure)

      private def takeRequests(): Unit =
        for frame <- heldBack do
          heldBack = None
          take(frame)
        while !consumed && heldBack.isEmpty && reason.isEmpty && inFlight < limits.inFlightPerConnection &&
          writer.length < limits.unsentBytesPerConnection && hasRoom && turn.resize(inFlight + 1L)
        do
          framer.next() match
            case Framed.Complete(frame) =>
              patience.completed()
              take(frame)
            case Framed.NeedsMore =>
              consumed = true
              segment = 0
            case Framed.Malformed(problem) => refuse(ServerLimit.Malformed, problem)
        // The rest of the message may never arrive: only the connection's own requests are worth waiting for.
        if consumed && reason.isEmpty && !mayRead && !underWay then tooMuch()
        turn.force(inFlight)
        holding.force(held)

      private def held: Long =
        segment.toLong + framer.heldBytes + heldBack.fold(0)(_.length) + inHand + writer.length + sending

      private def isGranted: Boolean = holding.resize(held) && holding.isGranted

      private def underWay: Boolean = inFlight > 0 || sending > 0 || writer.length > 0

      /** Whether the connection may take a request: its memory is granted, or it has nothing in progress that
        * would free memory when it ends.
        */
      private def hasRoom: Boolean = isGranted || !underWay

      /** Whether the connection may read the rest of the incomplete message. */
      private def mayRead: Boolean = isGranted || framer.heldBytes <= limits.heldBytesPerConnection

      private def tooMuch(): Unit = refuse(ServerLimit.Held, s"$held bytes of it are held, and $noMore")

      private def noMore: String =
        s"no more than ${limits.heldBytesInCommon} in all beyond " +
          s"${limits.heldBytesPerConnection} for each connection"

      private def take(frame: Array[Byte]): Unit =
        val bytes = framer.decodedBytes + BytesPerRequest
        if holding.resize(held + bytes) || bytes <= limits.heldBytesPerConnection then
          backFor = 0
          handle(frame, bytes)
        else if underWay && ServerLimits.Watch * backFor.toLong < limits.messageTime then
          heldBack = Some(frame)
        else
          backFor = 0
          counters.lacking.increment()
          // Not decoded: decoding needs the memory that is lacking.
          RpcMessage.idIn(frame).filter(id => id >= 0 && id <= RpcMessage.MaxId) match
            case Some(id) =>
              counters.requests.increment()
              counters.refused.increment()
              writer.reply(id, Left(s"this request takes $bytes bytes of the server's memory, and $noMore"))
            case None => ignore(s"a message that asks for no answer and takes $bytes bytes, and $noMore")

      private def handle(frame: Array[Byte], bytes: Long): Unit =
        RpcMessage.fromClient(frame) match
          case RpcMessage.Request(id, method, params) =>
            counters.requests.increment()
            run(id, RpcRequest(connection, method, params, notification = false), bytes)
          case RpcMessage.Notification(method, params) =>
            counters.notifications.increment()
            run(NoReply, RpcRequest(connection, method, params, notification = true), bytes)
          case RpcMessage.Malformed(problem) => refuse(ServerLimit.Malformed, problem)
          case RpcMessage.Ignored(what)      => ignore(what)
          case other: RpcMessage.Reply       => ignore(other.productPrefix)

      private def ignore(what: String): Unit =
        strays += 1
        observe(ServerEvent.Ignored(connection, what))
        if !spoken then
          refuse(ServerLimit.Malformed, s"expected a message of MessagePack-RPC first, got $what")
        else if strays > limits.strays then
          refuse(ServerLimit.Malformed, s"more than ${limits.strays} values in a row that are no messages")

      private def run(id: Long, request: RpcRequest, bytes: Long): Unit =
        val answer =
          try handler(request)
          catch case NonFatal(failure) => Future.failed(failure)
        strays = 0
        spoken = true
        inFlight += 1
        inHand += bytes
        answer.value match
          case Some(result) => finish(Outcome(id, request, bytes, result))
          case None         =>
            answer.onComplete(result => completed(Outcome(id, request, bytes, result)))(using
              ExecutionContext.parasitic
            )

      /** Accepts a request's outcome; from any thread. */
      private def completed(outcome: Outcome): Unit =
        val _ = done.add(outcome)
        if scheduled.compareAndSet(false, true) then wake.invoke(())

      private def collect(): Unit =
        scheduled.set(false)
        Iterator.continually(done.poll()).takeWhile(_ != null).foreach(finish)
        proceed()

      private def finish(outcome: Outcome): Unit =
        inFlight -= 1
        inHand -= outcome.bytes
        if outcome.id != NoReply then
          val reply = outcome.result match
            case Success(answer)  => answer
            case Failure(failure) =>
              val text = Option(failure.getMessage).getOrElse(failure.toString)
              Left(Rpclib.threw(outcome.request.method, outcome.request.params.length, text))
          val before = writer.length
          writer.reply(outcome.id, reply)
          val size    = writer.length - before
          val lacking = !holding.resize(held) && held > 2 * limits.heldBytesPerConnection
          if lacking then
            counters.lacking.increment()
            writer.backTo(before)
            writer.reply(outcome.id, Left(s"the reply takes $size bytes of the server's memory, and $noMore"))
          (if reply.isRight && !lacking then counters.answered else counters.refused).increment()

private object ServerConnection:
  private val NoReply = -1L

  /** Memory of a request in addition to its message, bytes: the objects that track it until its answer. */
  private val BytesPerRequest = 512

  /** The first bytes of an array of three or four elements: the only ones that MessagePack's and AirSim's
    * clients send.
    */
  private[rpc] val Starts = Set(0x93, 0x94, 0xdc, 0xdd)

  private case object Watch
  private final case class Outcome(
      id: Long,
      request: RpcRequest,
      bytes: Long,
      result: Try[Either[String, Msg | Encoded]]
  )
