package skein.rpc

import java.util.concurrent.ConcurrentLinkedQueue
import java.util.concurrent.atomic.AtomicBoolean
import org.apache.pekko.stream.stage.*
import org.apache.pekko.stream.{Attributes, FlowShape, Inlet, Outlet}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future}
import scala.util.control.NonFatal
import scala.util.{Failure, Success, Try}
import upack.Msg

/** Serves one connection: requests' bytes in, replies' bytes out, replies in the order of completion.
  *
  * '''Emits when''' replies are ready; those ready together leave together.
  * '''Backpressures when''' its limit of requests being handled, or of reply bytes not yet taken, is reached.
  * '''Completes when''' upstream has completed and every request is answered, or at once on malformed input.
  * '''Cancels when''' downstream cancels, or on malformed input.
  */
private[rpc] final class ServerConnection(
    connection: Long,
    limits: ServerLimits,
    handler: RpcServer.Handler,
    failureText: (RpcRequest, Throwable) => String,
    counters: ServerCounters,
    observe: ServerEvent => Unit
) extends GraphStage[FlowShape[ByteString, ByteString]]:
  import ServerConnection.*

  private val in  = Inlet[ByteString]("requests")
  private val out = Outlet[ByteString]("replies")

  override val shape: FlowShape[ByteString, ByteString] = FlowShape(in, out)

  override def createLogic(inherited: Attributes): GraphStageLogic =
    new GraphStageLogic(shape) with InHandler with OutHandler:
      private val framer    = Framer(limits.frame)
      private val writer    = MessageWriter()
      private val done      = ConcurrentLinkedQueue[Outcome]()
      private val scheduled = AtomicBoolean()
      private val wake      = getAsyncCallback[Unit](_ => collect())
      private var inFlight  = 0
      private var consumed  = true // every value of the last segment is taken
      private var reason    = Option.empty[String]

      setHandlers(in, out, this)

      override def preStart(): Unit = pull(in)

      override def onPush(): Unit =
        framer.offer(grab(in))
        consumed = false
        proceed()

      override def onPull(): Unit = proceed()

      override def onUpstreamFinish(): Unit = proceed()

      override def onUpstreamFailure(failure: Throwable): Unit =
        reason = Some(Option(failure.getMessage).getOrElse(failure.toString))
        failStage(failure)

      override def postStop(): Unit = observe(ServerEvent.Closed(connection, reason))

      /** Takes requests as far as the limits allow, and sends what is ready. */
      private def proceed(): Unit =
        takeRequests()
        if isAvailable(out) && writer.length > 0 then
          push(out, writer.take())
          takeRequests()
        if reason.nonEmpty then completeStage()
        else if consumed then
          if !isClosed(in) then
            if !hasBeenPulled(in) then pull(in)
          else if inFlight == 0 && writer.length == 0 then
            if framer.midway then reason = Some("the peer stopped in the middle of a message")
            completeStage()

      private def takeRequests(): Unit =
        while !consumed && reason.isEmpty && inFlight < limits.inFlightPerConnection &&
          writer.length < limits.unsentBytesPerConnection
        do
          framer.next() match
            case Framed.Complete(frame)    => take(frame)
            case Framed.NeedsMore          => consumed = true
            case Framed.Malformed(problem) => reason = Some(problem)

      private def take(frame: Array[Byte]): Unit = Message.fromClient(frame) match
        case Message.Request(id, method, params) =>
          counters.requests.increment()
          handle(id, RpcRequest(connection, method, params, notification = false))
        case Message.Notification(method, params) =>
          counters.notifications.increment()
          handle(NoReply, RpcRequest(connection, method, params, notification = true))
        case Message.Malformed(problem) => reason = Some(problem)
        case Message.Ignored(what)      => observe(ServerEvent.Ignored(connection, what))
        case other: Message.Reply       => observe(ServerEvent.Ignored(connection, other.toString))

      private def handle(id: Long, request: RpcRequest): Unit =
        val answer =
          try handler(request)
          catch case NonFatal(failure) => Future.failed(failure)
        inFlight += 1
        answer.value match
          case Some(result) => finish(Outcome(id, request, result))
          case None         =>
            answer.onComplete(result => completed(Outcome(id, request, result)))(using
              ExecutionContext.parasitic
            )

      /** From any thread. */
      private def completed(outcome: Outcome): Unit =
        val _ = done.add(outcome)
        if scheduled.compareAndSet(false, true) then wake.invoke(())

      private def collect(): Unit =
        scheduled.set(false)
        var outcome = done.poll()
        while outcome != null do
          finish(outcome)
          outcome = done.poll()
        proceed()

      private def finish(outcome: Outcome): Unit =
        inFlight -= 1
        if outcome.id != NoReply then
          val reply = outcome.result match
            case Success(answer)  => answer
            case Failure(failure) => Left(failureText(outcome.request, failure))
          (if reply.isRight then counters.answered else counters.refused).increment()
          writer.reply(outcome.id, reply)

private object ServerConnection:
  private val NoReply = -1L

  private final case class Outcome(id: Long, request: RpcRequest, result: Try[Either[String, Msg]])
