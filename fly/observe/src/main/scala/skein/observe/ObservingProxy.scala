package skein.observe

import com.typesafe.config.{Config, ConfigFactory}
import java.util.concurrent.atomic.{AtomicInteger, AtomicLong}
import java.util.concurrent.{ConcurrentLinkedQueue, Executor}
import org.apache.pekko.Done
import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{BidiFlow, Flow}
import org.apache.pekko.util.ByteString
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.control.NonFatal
import skein.link.*
import skein.units.{Clock, Instant, Span}

/** A proxy between clients and their simulator that analyses their loop. It changes nothing: bytes pass in
  * their order, none is added, held back or lost, whatever they mean; datagrams as the link lets them.
  *
  * Passed pieces are analysed elsewhere, one after the other. The analysis may lag behind by
  * [[ObservingProxy.MostWaiting]] bytes; pieces beyond pass without analysis and are counted, and their
  * connection is not analysed any more, unless it carries datagrams.
  */
final class ObservingProxy[A] private (
    proxy: LinkProxy,
    looking: ObservingProxy.Looking[A]
):
  import ObservingProxy.*

  /** The address that clients connect to, with the actual port. */
  def address: Address = proxy.address

  /** Present progress; may be called repeatedly while it observes. */
  def progress: Progress = looking.progress

  /** Commands since the last call, for each vehicle. */
  def takeNew(): Vector[NewCommands] = looking.takeNew()

  /** The observations so far; later messages are analysed after it. */
  def observed: A = looking.observed

  /** Completes when the clients have left and their last bytes have arrived, at the latest after
    * [[ObservingProxy.MostEnding]].
    */
  def ended(): Future[Done] = proxy.ended(MostEnding)

  /** Accepts no more connections, closes the open ones, and analyses what has passed until then. Fails if the
    * analysis has failed, which is a defect; bytes passed nevertheless.
    */
  def close(): Future[Done] =
    given ExecutionContext = ExecutionContext.parasitic
    val looked             = Promise[Done]()
    proxy.close().flatMap(_ => ended()).flatMap: _ =>
      looking.add(Piece.End(failure => looked.complete(failure.toLeft(Done).toTry): Unit))
      looked.future

object ObservingProxy:
  /** Settings of an actor system whose connections pass images: bytes are read by up to 1 MiB, which takes a
    * third less processor time than by Pekko's 128 KiB.
    */
  val Settings: Config =
    ConfigFactory.parseString("pekko.io.tcp.direct-buffer-size = 1 MiB").withFallback(ConfigFactory.load())

  /** Maximum number of bytes that have passed and wait for analysis. */
  val MostWaiting: Long = 256L << 20

  /** Datagrams have no end, so with them this time passes whole. */
  val MostEnding: Span = Span.ofSeconds(2)

  private enum Piece:
    case Opened(connection: Int, at: Instant)
    case Bytes(connection: Int, isFromClient: Boolean, bytes: ByteString, at: Instant)
    case Closed(connection: Int, at: Instant)
    case End(looked: Option[Throwable] => Unit)

  /** Starts listening. Fails with a [[TransportError]] if that is not possible.
    *
    * @param link the link emulated between the observer and the simulator
    * @param reader executes the analysis; a separate thread in real time
    * @param unreachable called with the reason, if an accepted connection cannot be continued to the
    *   simulator, or speaks another protocol: see [[LinkProxy]], whose seats its connections take
    * @param isDatagrams whether the transport carries datagrams
    */
  def start[A](
      analysis: Analysis[A],
      listenAt: Address,
      simulator: Address,
      link: EmulatedLink,
      transport: Transport,
      clock: Clock,
      reader: Executor,
      unreachable: Throwable => Unit = _ => (),
      isDatagrams: Boolean = false
  )(using ActorSystem): Future[ObservingProxy[A]] =
    given ExecutionContext = ExecutionContext.parasitic
    val looking            = Looking(analysis, reader)

    def passing(connection: Int, isFromClient: Boolean, whole: Whole): Flow[ByteString, ByteString, NotUsed] =
      Flow[ByteString].map: bytes =>
        if whole.is then
          whole.is =
            looking.offer(Piece.Bytes(connection, isFromClient, bytes, clock.now())) || isDatagrams
        bytes

    object watching extends LinkProxy.Watching:
      def opened(connection: Long): BidiFlow[ByteString, ByteString, ByteString, ByteString, NotUsed] =
        val whole = Whole()
        looking.add(Piece.Opened(connection.toInt, clock.now()))
        BidiFlow.fromFlows(passing(connection.toInt, true, whole), passing(connection.toInt, false, whole))

      def closed(connection: Long): Unit = looking.add(Piece.Closed(connection.toInt, clock.now()))

    LinkProxy
      .start(
        listenAt,
        simulator,
        link,
        transport,
        unreachable = unreachable,
        isDatagrams = isDatagrams,
        watching = watching
      )
      .map(ObservingProxy(_, looking))

  /** Whether all bytes of a connection were analysed. */
  private final class Whole:
    @volatile var is = true

  /** Analyses pieces in their order, one at a time. Thread-safe; adding never blocks. */
  private final class Looking[A](analysis: Analysis[A], reader: Executor):
    private val pieces  = ConcurrentLinkedQueue[Piece]()
    private val count   = AtomicInteger()
    private val waiting = AtomicLong()
    private val missed  = AtomicLong()
    private var failure = Option.empty[Throwable]

    def progress: Progress = synchronized(analysis.progress)

    def takeNew(): Vector[NewCommands] = synchronized(analysis.takeNew())

    def observed: A = synchronized:
      analysis.passedOver(missed.getAndSet(0))
      analysis.observed

    /** Adds a piece; false if the queue is full, and then the piece is skipped. */
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
        val piece = pieces.poll()
        try if failure.isEmpty then look(piece)
        catch case NonFatal(defect) => failure = Some(defect)
        piece match
          case Piece.End(looked)           => looked(failure)
          case Piece.Bytes(_, _, bytes, _) => waiting.addAndGet(-bytes.size): Unit
          case _                           => ()
        left = count.decrementAndGet() > 0

    private def look(piece: Piece): Unit = piece match
      case Piece.Opened(connection, at)                     => synchronized(analysis.opened(connection, at))
      case Piece.Bytes(connection, isFromClient, bytes, at) =>
        synchronized(analysis.passed(connection, isFromClient, bytes, at))
      case Piece.Closed(connection, at) => synchronized(analysis.closed(connection, at))
      case Piece.End(_)                 => ()
