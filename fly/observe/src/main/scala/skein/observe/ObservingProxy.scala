package skein.observe

import java.util.concurrent.atomic.{AtomicInteger, AtomicLong}
import java.util.concurrent.{ConcurrentLinkedQueue, Executor}
import org.apache.pekko.Done
import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{BidiFlow, Flow, Keep, Sink}
import org.apache.pekko.stream.{KillSwitches, SharedKillSwitch}
import org.apache.pekko.util.ByteString
import scala.collection.mutable
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.link.*
import skein.units.{Clock, Instant}

/** Stands between clients and their simulator, and keeps account of their loop. It changes nothing: bytes
  * pass in their order, none is added, held back or lost, whatever they mean.
  *
  * What passes is looked at elsewhere, one piece after the other. That may lag behind by
  * [[ObservingProxy.MostWaiting]]; what comes beyond is passed on and not looked at, which is counted, and
  * its connection is not understood any more.
  */
final class ObservingProxy private (
    listening: Listening,
    switch: SharedKillSwitch,
    looking: ObservingProxy.Looking
):
  import ObservingProxy.*

  /** Where clients connect to, with the actual port. */
  def address: Address = listening.address

  /** To be asked now and then, while it observes. */
  def progress: Progress = looking.progress

  /** What is known now; what passes meanwhile is looked at after that. */
  def observed: Observed = looking.observed

  /** Accepts no more, closes the open connections, and looks at what has passed until now. */
  def close(): Future[Done] =
    given ExecutionContext = ExecutionContext.parasitic
    switch.shutdown()
    val looked = Promise[Done]()
    listening.close().flatMap: _ =>
      looking.add(Piece.End(() => looked.success(Done): Unit))
      looked.future

object ObservingProxy:
  /** Bytes that have passed and were not looked at yet. */
  val MostWaiting: Long = 256L << 20

  private val MostConnections = 1024

  private enum Piece:
    case Opened(connection: Int, at: Instant)
    case Bytes(connection: Int, isFromClient: Boolean, bytes: ByteString, at: Instant)
    case Closed(connection: Int, at: Instant)
    case End(looked: () => Unit)

  /** Starts listening. Fails with a [[TransportError]] where that is not possible.
    *
    * @param link emulated between the observer and the simulator
    * @param reader runs what looks at the pieces; a thread of its own, where time is real
    * @param unreachable told why, when an accepted connection cannot be continued to the simulator
    */
  def start(
      listenAt: Address,
      simulator: Address,
      link: EmulatedLink,
      transport: Transport,
      clock: Clock,
      reader: Executor,
      unreachable: Throwable => Unit = _ => ()
  )(using ActorSystem): Future[ObservingProxy] =
    given ExecutionContext = ExecutionContext.parasitic
    val switch             = KillSwitches.shared("observing-proxy")
    val looking            = Looking(reader)
    val count              = AtomicInteger()

    def passing(connection: Int, isFromClient: Boolean, whole: Whole): Flow[ByteString, ByteString, NotUsed] =
      Flow[ByteString].map: bytes =>
        if whole.is then
          whole.is = looking.offer(Piece.Bytes(connection, isFromClient, bytes, clock.now()))
        bytes

    def forward(incoming: Incoming): Future[Done] =
      val connection = count.getAndIncrement()
      val whole      = Whole()
      looking.add(Piece.Opened(connection, clock.now()))
      val server = BidiFlow
        .fromFlows(
          passing(connection, true, whole).via(switch.flow),
          passing(connection, false, whole).via(switch.flow)
        )
        .atop(link.connection(TransportError.Lost(simulator, "the link broke")))
        .joinMat(transport.connect(simulator))(Keep.right)
      val (sent, (reached, answered)) = incoming.flow
        .watchTermination()(Keep.right)
        .joinMat(server.watchTermination()(Keep.both))(Keep.both)
        .run()
      reached.failed.foreach(unreachable)
      for
        _ <- sent.recover(_ => Done)
        _ <- answered.recover(_ => Done)
      yield
        looking.add(Piece.Closed(connection, clock.now()))
        Done

    transport
      .listen(listenAt)
      .mapAsyncUnordered(MostConnections)(forward)
      .toMat(Sink.ignore)(Keep.left)
      .run()
      .map(ObservingProxy(_, switch, looking))

  /** Whether all of a connection was looked at. */
  private final class Whole:
    @volatile var is = true

  /** Looks at pieces in their order, one at a time. Added to from any thread; never blocks. */
  private final class Looking(reader: Executor):
    private val pieces        = ConcurrentLinkedQueue[Piece]()
    private val count         = AtomicInteger()
    private val waiting       = AtomicLong()
    private val missed        = AtomicLong()
    private val account       = LoopAccount()
    private val conversations = mutable.LongMap.empty[Conversation]

    def progress: Progress = synchronized(account.progress)

    def observed: Observed = synchronized:
      account.passedOver(missed.getAndSet(0))
      account.observed

    /** @return false where too much waits; then it is left out
      */
    def offer(piece: Piece.Bytes): Boolean =
      val fits = waiting.addAndGet(piece.bytes.size) <= MostWaiting
      if fits then add(piece)
      else
        waiting.addAndGet(-piece.bytes.size)
        missed.incrementAndGet(): Unit
      fits

    def add(piece: Piece): Unit =
      pieces.add(piece): Unit
      if count.getAndIncrement() == 0 then reader.execute(() => drain())

    private def drain(): Unit =
      var left = true
      while left do
        look(pieces.poll())
        left = count.decrementAndGet() > 0

    private def look(piece: Piece): Unit = piece match
      case Piece.Opened(connection, at) =>
        synchronized:
          conversations(connection) = Conversation(connection)
          account.add(Passed.Opened(connection, at))
      case Piece.Bytes(connection, isFromClient, bytes, at) =>
        waiting.addAndGet(-bytes.size): Unit
        synchronized:
          conversations.get(connection).foreach: known =>
            val passed = if isFromClient then known.fromClient(bytes, at) else known.fromSimulator(bytes, at)
            passed.foreach(account.add)
      case Piece.Closed(connection, at) =>
        synchronized:
          conversations.remove(connection): Unit
          account.add(Passed.Closed(connection, at))
      case Piece.End(looked) => looked()
