package skein.rpc

import java.util.concurrent.ConcurrentLinkedQueue
import java.util.concurrent.atomic.{AtomicBoolean, AtomicInteger}
import org.apache.pekko.Done
import org.apache.pekko.stream.scaladsl.{Keep, Source}
import org.apache.pekko.stream.stage.*
import org.apache.pekko.stream.{Attributes, ClosedShape}
import org.apache.pekko.util.ByteString
import scala.collection.mutable
import scala.concurrent.duration.Duration
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.control.NonFatal
import scala.util.{Failure, Random, Success, Try}
import skein.link.{Address, Transport}
import skein.units.*
import upack.Msg

/** Submits calls to a running channel; from any thread. */
private[rpc] trait ChannelInput:
  def submit(call: Call): Unit

  /** Ends a submitted call, unless it has ended. */
  def withdraw(call: Call): Unit
  def close(): Future[Done]

/** One channel with all its connections in a single stage, hence on one thread at a time: a call costs one
  * hop to that thread, calls made during that hop leave in one write, and [[ChannelState]] makes every
  * decision. The connections run fused inside this stage.
  *
  *   - '''Emits when''' nothing; it has no ports. Requests go to the channel's connections.
  *   - '''Backpressures when''' a connection takes no more bytes: its calls wait, unwritten, within its
  *     window.
  *   - '''Completes when''' closed through its [[ChannelInput]].
  *   - '''Cancels when''' never.
  */
private[rpc] final class ChannelStage(
    channel: Channel,
    transport: Transport,
    address: Address,
    clock: Clock,
    settings: RpcSettings,
    seed: Long,
    counters: RpcCounters,
    holdings: Holdings,
    observe: RpcEvent => Unit
) extends GraphStageWithMaterializedValue[ClosedShape, ChannelInput]:

  override val shape: ClosedShape = ClosedShape

  override def createLogicAndMaterializedValue(inherited: Attributes): (GraphStageLogic, ChannelInput) =
    val logic = Logic()
    (logic, logic)

  private final class Logic extends TimerGraphStageLogic(shape) with ChannelInput with ChannelEffects:
    private val random = Random(seed)
    private val state  = ChannelState(channel, address, settings, counters, () => random.nextDouble(), this)
    private val connections = Array.tabulate(settings.connections(channel))(Connection(_))
    private var started     = false
    private var armedFor    = Option.empty[Instant]

    private val inbox             = ConcurrentLinkedQueue[Call]()
    private val pending           = AtomicInteger()
    private val scheduled         = AtomicBoolean()
    @volatile private var stopped = false
    private val stoppedDone       = Promise[Done]()
    private val wake              = getAsyncCallback[Unit](_ => drain())
    private val withdrawing       = getAsyncCallback[Call](withdrawNow)
    private val closing           = getAsyncCallback[Unit](_ => completeStage())

    // From any thread

    def submit(call: Call): Unit =
      if pending.incrementAndGet() > settings.windowInAll + settings.queue then
        reject(
          call,
          RpcError.Overloaded(call.method, s"${settings.windowInAll + settings.queue} calls are under way")
        )
      else
        val _ = inbox.add(call)
        if stopped then cancelInbox()
        else if scheduled.compareAndSet(false, true) then wake.invoke(())

    def withdraw(call: Call): Unit = withdrawing.invoke(call)

    def close(): Future[Done] =
      closing.invoke(())
      stoppedDone.future

    private def cancelInbox(): Unit =
      for call <- waitingCalls do reject(call, RpcError.Cancelled(call.method))

    private def waitingCalls: Iterator[Call] = Iterator.continually(inbox.poll()).takeWhile(_ != null)

    private def reject(call: Call, error: RpcError): Unit =
      counters.failed(error)
      observe(RpcEvent.Failed(call.method, channel, error))
      call.ended = true
      end(call, Left(error))

    // Effects

    def send(call: Call): Unit = connections(call.connection).toWrite.append(call)

    def end(call: Call, outcome: Either[RpcError, TimedReply[Msg | Received]]): Unit =
      val _ = pending.decrementAndGet()
      call.outcome.success(outcome)

    def reconnect(connection: Int, after: Span): Unit =
      scheduleOnce(connections(connection), after.toDuration)

    def observe(event: RpcEvent): Unit = ChannelStage.this.observe(event)

    // On the stage's thread

    override def preStart(): Unit = setKeepGoing(true)

    override def postStop(): Unit =
      state.close()
      stopped = true
      cancelInbox()
      val _ = stoppedDone.trySuccess(Done)

    override protected def onTimer(key: Any): Unit = key match
      case connection: Connection => connection.open()
      case attempt: Attempt       => attempt.messageDue()
      // Other events of this instant are handled first, whenever their timers were set: an answer counts, and
      // a loop's tick finds the call unanswered. Else virtual flights would depend on what else is called.
      case Deadline => scheduleOnce(Expire, Duration.Zero)
      case _        =>
        armedFor = None
        state.expire(clock.now())
        settle()

    private def drain(): Unit =
      scheduled.set(false)
      if !started then
        started = true
        connections.foreach(_.open())
      val now = clock.now()
      waitingCalls.foreach(state.submit(_, now))
      settle()

    private def withdrawNow(call: Call): Unit =
      state.withdraw(call, clock.now())
      settle()

    /** After every change: writes what may be written, and schedules the next deadline. */
    private def settle(): Unit =
      connections.foreach(_.flush())
      for next <- state.nextDeadline if armedFor.forall(next < _) do
        armedFor = Some(next)
        scheduleOnce(Deadline, next.since(clock.now()).max(Span.Zero).toDuration)

    private final class Connection(index: Int):
      val toWrite         = mutable.ArrayDeque.empty[Call]
      private val writer  = MessageWriter()
      private var attempt = Option.empty[Attempt]

      def open(): Unit =
        val fresh = Attempt(this)
        attempt = Some(fresh)
        fresh.start()

      def opened(): Unit =
        state.opened(index)
        settle()

      def openFailed(reason: String): Unit =
        attempt = None
        state.openFailed(index, reason)
        settle()

      def lost(reason: String, malformed: Boolean): Unit =
        attempt = None
        toWrite.clear()
        state.lost(index, reason, malformed)
        settle()

      /** Takes a reply; whether a call of ours was waiting for it. */
      def received(reply: RpcMessage.Reply, now: Instant): Boolean = state.replied(index, reply, now)

      def ignored(what: String): Unit = state.ignored(index, what)

      /** Writes all calls assigned since the last write together. */
      def flush(): Unit =
        for target <- attempt if toWrite.nonEmpty && target.accepts do
          val now = clock.now()
          while toWrite.nonEmpty && writer.length < ChannelStage.LargestWrite do
            val call = toWrite.removeHead()
            if !call.ended then
              writer.request(call.id, call.method, call.params)
              call.written = true
              call.sends += 1
              call.sentAt = now
              counters.sent.increment()
          if writer.length > 0 then target.write(writer.take())

    /** One attempt to open a connection, and the connection if it succeeds. */
    private final class Attempt(connection: Connection):
      private val requests = SubSourceOutlet[ByteString](s"$channel-requests")
      private val replies  = SubSinkInlet[ByteString](s"$channel-replies")
      private val framer   = Framer(settings.limits(channel))
      private val holding  = holdings.Holding()
      private var up       = false
      private var over     = false
      private var strays   = 0
      private var begun    = Option.empty[Instant] // when the message under way did
      private var watched  = false
      private var early = Option.empty[String] // why the stream ended before the connection was reported open

      def accepts: Boolean = up && !over && requests.isAvailable

      def write(bytes: ByteString): Unit = requests.push(bytes)

      def start(): Unit =
        requests.setHandler(new OutHandler:
          override def onPull(): Unit                             = connection.flush()
          override def onDownstreamFinish(cause: Throwable): Unit = ended("the peer closed it"))
        replies.setHandler(new InHandler:
          override def onPush(): Unit                              = read(replies.grab())
          override def onUpstreamFinish(): Unit                    = ended("the peer closed it")
          override def onUpstreamFailure(failure: Throwable): Unit = ended(reasonOf(failure)))
        val connected = getAsyncCallback[Try[Done]](onConnected)
        try
          Source
            .fromGraph(requests.source)
            .viaMat(transport.connect(address))(Keep.right)
            .to(replies.sink)
            .run()(using subFusingMaterializer)
            .onComplete(connected.invoke)(using ExecutionContext.parasitic)
          if !over then replies.pull()
        catch case NonFatal(failure) => onConnected(Failure(failure))

      private def onConnected(result: Try[Done]): Unit = result match
        case Success(_) if !over =>
          up = true
          connection.opened()
          early.foreach(ended(_))
        case Failure(failure) if !up && !over =>
          over = true
          shut()
          connection.openFailed(reasonOf(failure))
        case _ => ()

      /** The stream has ended. Waits for the report whether the connection was opened or failed, if that is
        * still missing.
        */
      private def ended(reason: String, malformed: Boolean = false): Unit =
        if !up then early = early.orElse(Some(reason))
        else if !over then
          over = true
          shut()
          connection.lost(reason, malformed)

      private def shut(): Unit =
        holding.force(0)
        if !requests.isClosed then requests.complete()
        if !replies.isClosed then replies.cancel()

      private def read(segment: ByteString): Unit =
        val now = clock.now()
        framer.offer(segment)
        var more = !over
        while more do
          framer.next() match
            case Framed.Complete(frame) =>
              begun = None
              (if channel == Channel.Bulk then RpcMessage.fromServerUnread(frame)
               else RpcMessage.fromServer(frame)) match
                case reply: RpcMessage.Reply =>
                  if connection.received(reply, now) then strays = 0 else strays += 1
                case RpcMessage.Ignored(what)     => stray(what)
                case RpcMessage.Malformed(reason) => ended(reason, malformed = true)
                case other                        => stray(other.productPrefix)
              if strays > settings.strays then
                ended(s"more than ${settings.strays} values in a row that answer no call", malformed = true)
              more = !over
            case Framed.NeedsMore =>
              more = false
              keep(now)
            case Framed.Malformed(reason) =>
              more = false
              ended(reason, malformed = true)
        if !over then replies.pull()
        settle()

      private def stray(what: String): Unit =
        strays += 1
        connection.ignored(what)

      /** Tracks the incomplete message: since when it arrives, and how many of its bytes are held. */
      private def keep(now: Instant): Unit =
        if !framer.midway then begun = None
        else if begun.isEmpty then
          begun = Some(now)
          if !watched then watch(settings.messageTime)
        if !holding.resize(framer.heldBytes) then
          ended(
            s"${framer.heldBytes} bytes of an unfinished message are " +
              s"held, and no more than ${settings.openBytes} in all",
            malformed = true
          )

      private def watch(after: Span): Unit =
        watched = true
        scheduleOnce(this, after.toDuration)

      def messageDue(): Unit =
        watched = false
        for since <- begun if !over do
          val left = settings.messageTime - clock.now().since(since)
          if left > Span.Zero then watch(left)
          else
            ended(
              s"a message under way for more than ${math.round(settings.messageTime.toSeconds)} s",
              malformed = true
            )
            settle()

  private def reasonOf(failure: Throwable): String = Option(failure.getMessage).getOrElse(failure.toString)

  private case object Deadline

  private case object Expire

private object ChannelStage:
  /** Bytes after which a write takes no further calls. */
  private val LargestWrite = 128 << 10
