package skein.rpc

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.RunnableGraph
import scala.concurrent.{ExecutionContext, Future}
import scala.util.control.NonFatal
import skein.link.{Address, Transport}
import skein.units.Clock
import upack.{Arr, Msg, Null, Obj, Str}
import upickle.default.Reader
import upickle.core.{AbortException, TraceVisitor}

/** Calls a MessagePack-RPC server over a pool of connections and never blocks: every call is a future that
  * ends exactly once, with a result or an [[RpcError]], no later than its timeout. Safe from any thread.
  *
  * Timeouts and pauses are as exact as the actor system's scheduler: about 0.1 ms with
  * [[skein.link.PreciseScheduler]], 10 ms and more with Pekko's own. Messages leave fastest with
  * `pekko.stream.materializer.io.tcp.coalesce-writes = 0`, because they are gathered here already.
  *
  * @param transport opens connections; it bounds the time to connect
  * @param seed seed of the jitter in the pauses between attempts to connect
  * @param observer called with every event on the channels' threads, so it must be quick, thread-safe, and
  *   throw nothing
  */
final class RpcClient(
    transport: Transport,
    val address: Address,
    clock: Clock,
    settings: RpcSettings = RpcSettings(),
    seed: Long = 0L,
    observer: RpcEvent => Unit = _ => ()
)(using system: ActorSystem):

  private given ExecutionContext = ExecutionContext.parasitic

  private val counters = RpcCounters()
  private val holdings = settings.newHoldings()
  private val control  = start(Channel.Control)
  private val bulk     = start(Channel.Bulk)
  private val sensors  = start(Channel.Sensors)

  /** Calls `method` and returns its result undecoded. */
  def call(
      method: String,
      params: Seq[Msg],
      options: CallOptions = CallOptions()
  ): Future[Either[RpcError, Msg]] =
    callStamped(method, params, options).map(_.map(_.value))

  /** Calls `method` and reads its result as an `A`; [[RpcError.Malformed]] if it cannot be read. */
  def callAs[A: Reader](
      method: String,
      params: Seq[Msg],
      options: CallOptions = CallOptions()
  ): Future[Either[RpcError, A]] =
    callStamped(method, params, options).map(_.flatMap(answer => read[A](method, answer.value)))

  /** Calls `method` and returns its result with the times of sending and receiving. */
  def callStamped(
      method: String,
      params: Seq[Msg],
      options: CallOptions = CallOptions()
  ): Future[Either[RpcError, TimedReply[Msg]]] =
    submit(method, params, options).map(_.flatMap(answer =>
      answer.value match
        case read: Msg          => Right(answer.copy(value = read))
        case received: Received =>
          try Right(answer.copy(value = upack.read(received.toArray, trace = false)))
          catch case NonFatal(e) => Left(RpcError.Malformed(method, s"not readable as MessagePack: $e"))
    ))

  /** Calls `method` on [[Channel.Bulk]], for large results, and reads its result directly from its message's
    * bytes. They are copied once, from the transport's segments; binary in the result refers to them.
    */
  def callBulk[A](method: String, params: Seq[Msg], options: CallOptions = CallOptions())(
      read: MessageReader => A
  ): Future[Either[RpcError, TimedReply[A]]] =
    submit(method, params, options.copy(channel = Channel.Bulk)).map(_.flatMap(answer =>
      answer.value match
        case received: Received =>
          MessageReader.read(received)(read).map(value => answer.copy(value = value)).left.map(
            RpcError.Malformed(method, _)
          )
        case other: Msg =>
          Left(RpcError.Malformed(method, s"expected a large result, got ${RpcMessage.kindOf(other)}"))
    ))

  private def submit(
      method: String,
      params: Seq[Msg],
      options: CallOptions
  ): Future[Either[RpcError, TimedReply[Msg | Received]]] =
    val call = Call(method, params, options, clock.now())
    counters.called.increment()
    val channel = options.channel match
      case Channel.Control => control
      case Channel.Sensors => sensors
      case Channel.Bulk    => bulk
    channel.submit(call)
    options.withdrawn.foreach(_.onComplete(_ => channel.withdraw(call)))
    call.outcome.future

  /** Like [[callStamped]], with the result read as an `A`. */
  def callStampedAs[A: Reader](
      method: String,
      params: Seq[Msg],
      options: CallOptions = CallOptions()
  ): Future[Either[RpcError, TimedReply[A]]] =
    callStamped(method, params, options).map(
      _.flatMap(answer => read[A](method, answer.value).map(value => answer.map(_ => value)))
    )

  def stats: RpcStats = counters.snapshot

  /** Ends current and later calls with [[RpcError.Cancelled]], and closes all connections. */
  def close(): Future[Done] =
    Future.traverse(Vector(control, sensors, bulk))(_.close()).map(_ => Done)

  private def read[A: Reader](method: String, value: Msg): Either[RpcError, A] =
    def readAs(trace: Boolean): A =
      val read = upickle.default.readBinary[A](value, trace)
      for where <- RpcClient.nilIn(value, read) do
        throw IllegalArgumentException(
          s"expected a value${if where.isEmpty then "" else s" in $where"}, got nil"
        )
      read
    // Tracking the position makes reading several times slower: only unreadable answers are read again with
    // it.
    try Right(readAs(trace = false))
    catch
      case NonFatal(_) =>
        try Right(readAs(trace = true))
        catch case NonFatal(e) => Left(RpcError.Malformed(method, RpcClient.unreadable(e)))

  private def start(channel: Channel): ChannelInput =
    val stage =
      ChannelStage(
        channel,
        transport,
        address,
        clock,
        settings,
        seed + channel.ordinal,
        counters,
        holdings,
        observer
      )
    RunnableGraph.fromGraph(stage).run()

object RpcClient:
  /** Describes what was expected in an answer and where, without class names. */
  private def unreadable(mistake: Throwable): String = mistake match
    case at: TraceVisitor.TraceException =>
      val where = at.jsonPath.stripPrefix("$").replaceAll("\\['?([^'\\]]*)'?\\]", ".$1").stripPrefix(".")
      unreadable(at.getCause) + (if where.isEmpty then "" else s" in $where")
    case ended: AbortException    => ended.clue
    case _: NumberFormatException => "expected a number, got a string"
    case other                    => Option(other.getMessage).getOrElse(s"$other")

  /** The dotted path of a nil in an answer where a value was read; None without one. Needed since a nil
    * number reads as 0.
    */
  private def nilIn(answer: Msg, read: Any): Option[String] =
    def within(parts: Iterator[(String, Msg, Any)]) = parts
      .flatMap((name, part, as) =>
        nilIn(part, as).map(inner => if inner.isEmpty then name else s"$name.$inner")
      )
      .nextOption()
    (answer, read) match
      case (_, _: Msg | None)             => None
      case (Null, _)                      => Some("")
      case (Arr(parts), all: Iterable[?]) =>
        within(all.iterator.zip(parts).zipWithIndex.map { case ((as, part), index) => (s"$index", part, as) })
      case (Obj(parts), structure: Product) =>
        within(
          structure.productElementNames
            .zip(structure.productIterator)
            .flatMap((name, as) => parts.get(Str(name)).map((name, _, as)))
        )
      case _ => None
