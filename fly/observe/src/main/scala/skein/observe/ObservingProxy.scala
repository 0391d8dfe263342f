package skein.observe

import java.util.concurrent.LinkedBlockingQueue
import java.util.concurrent.atomic.{AtomicInteger, AtomicLong}
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
  * What passes is looked at by a thread of its own. It may lag behind by [[ObservingProxy.MostWaiting]]; what
  * comes beyond is passed on and not looked at, which is counted, and its connection is not understood any
  * more.
  */
final class ObservingProxy private (
    listening: Listening,
    switch: SharedKillSwitch,
    pieces: LinkedBlockingQueue[ObservingProxy.Piece],
    account: LoopAccount
):
  import ObservingProxy.*

  /** Where clients connect to, with the actual port. */
  def address: Address = listening.address

  /** What is known now. */
  def observed: Observed = account.synchronized(account.observed)

  /** Accepts no more, closes the open connections, and looks at what has passed until now. */
  def close(): Future[Done] =
    given ExecutionContext = ExecutionContext.parasitic
    switch.shutdown()
    val looked = Promise[Done]()
    listening.close().flatMap: _ =>
      pieces.add(Piece.End(() => looked.success(Done): Unit)): Unit
      looked.future

object ObservingProxy:
  /** Bytes that have passed and were not looked at yet. */
  val MostWaiting: Long = 256L << 20

  private enum Piece:
    case Opened(connection: Int, at: Instant)
    case Bytes(connection: Int, isFromClient: Boolean, bytes: ByteString, at: Instant)
    case Closed(connection: Int, at: Instant)
    case End(looked: () => Unit)

  /** Starts listening. Fails with a [[TransportError]] where that is not possible.
    *
    * @param link emulated between the observer and the simulator
    * @param unreachable told why, when an accepted connection cannot be continued to the simulator
    */
  def start(
      listenAt: Address,
      simulator: Address,
      link: EmulatedLink,
      transport: Transport,
      clock: Clock,
      unreachable: Throwable => Unit = _ => ()
  )(using ActorSystem): Future[ObservingProxy] =
    given ExecutionContext = ExecutionContext.parasitic
    val switch             = KillSwitches.shared("observing-proxy")
    val pieces             = LinkedBlockingQueue[Piece]()
    val waiting            = AtomicLong()
    val account            = LoopAccount()
    val count              = AtomicInteger()
    val missed             = AtomicLong()
    val _                  = Thread
      .ofPlatform()
      .daemon()
      .name("skein-observe")
      .start(() => look(pieces, waiting, missed, account))

    def passing(
        connection: Int,
        isFromClient: Boolean,
        isWhole: Whole
    ): Flow[ByteString, ByteString, NotUsed] =
      Flow[ByteString].map: bytes =>
        if isWhole.is then
          if waiting.addAndGet(bytes.size) > MostWaiting then
            waiting.addAndGet(-bytes.size)
            missed.incrementAndGet()
            isWhole.is = false
          else pieces.add(Piece.Bytes(connection, isFromClient, bytes, clock.now())): Unit
        bytes

    def forward(incoming: Incoming): Future[Done] =
      val connection = count.getAndIncrement()
      val whole      = Whole()
      pieces.add(Piece.Opened(connection, clock.now())): Unit
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
        pieces.add(Piece.Closed(connection, clock.now())): Unit
        Done

    transport
      .listen(listenAt)
      .mapAsyncUnordered(MostConnections)(forward)
      .toMat(Sink.ignore)(Keep.left)
      .run()
      .map(ObservingProxy(_, switch, pieces, account))

  private val MostConnections = 1024

  /** Whether all of a connection was looked at. */
  private final class Whole:
    @volatile var is = true

  private def look(
      pieces: LinkedBlockingQueue[Piece],
      waiting: AtomicLong,
      missed: AtomicLong,
      account: LoopAccount
  ): Unit =
    val conversations = mutable.LongMap.empty[Conversation]
    var open          = true
    while open do
      val piece = pieces.take()
      account.synchronized:
        account.passedOver(missed.getAndSet(0))
        piece match
          case Piece.Opened(connection, at) =>
            conversations(connection) = Conversation(connection)
            account.add(Passed.Opened(connection, at))
          case Piece.Bytes(connection, isFromClient, bytes, at) =>
            waiting.addAndGet(-bytes.size): Unit
            conversations.get(connection).foreach: known =>
              val passed =
                if isFromClient then known.fromClient(bytes, at) else known.fromSimulator(bytes, at)
              passed.foreach(account.add)
          case Piece.Closed(connection, at) =>
            conversations.remove(connection): Unit
            account.add(Passed.Closed(connection, at))
          case Piece.End(looked) =>
            open = false
            looked()
