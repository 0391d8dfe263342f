package skein.rpc

import java.util.{Comparator, TreeSet}
import scala.collection.mutable
import scala.jdk.CollectionConverters.*
import skein.link.Address
import skein.units.*
import upack.{Msg, Null}

/** Effects that a [[ChannelState]] requests from the owner of the sockets. */
private[rpc] trait ChannelEffects:
  /** Writes a call to the open connection it was assigned to, as soon as possible. */
  def send(call: Call): Unit

  /** Ends the call with its result or its error. */
  def end(call: Call, outcome: Either[RpcError, TimedReply[Msg | Received]]): Unit

  /** Tries to open the connection again, after a pause. */
  def reconnect(connection: Int, after: Span): Unit

  def observe(event: RpcEvent): Unit

/** The decisions of one channel: which call goes out on which connection and when, what an answer or a loss
  * means for the calls in flight. Knows no socket, clock or thread: the owner passes the time and carries out
  * the effects.
  *
  * A call without a key goes to the open connection with the fewest calls in flight, in rotation among
  * equals; calls with equal keys always go to one connection. Waiting calls go out in order of arrival. While
  * a connection cannot be opened, calls that only it could carry fail immediately.
  *
  * @param uniform random numbers in [0, 1), for the jitter of reconnecting
  */
private[rpc] final class ChannelState(
    channel: Channel,
    address: Address,
    settings: RpcSettings,
    counters: RpcCounters,
    uniform: () => Double,
    effects: ChannelEffects
):
  import ChannelState.*

  private val connections = Array.fill(settings.connections(channel))(Connection(settings.rememberedIds))
  private val unkeyed     = waitingLine()
  private val deadlines   = TreeSet[Call](byDeadline)
  private var waiting     = 0
  private var inFlight    = 0
  private var sequence    = 0L
  private var rotation    = 0

  /** The time at which [[expire]] next has something to do. */
  def nextDeadline: Option[Instant] = if deadlines.isEmpty then None else Some(deadlines.first.deadline)

  def submit(call: Call, now: Instant): Unit =
    call.sequence = sequence
    sequence += 1
    val line  = lineOf(call)
    val place = if line.isEmpty then placeFor(call) else NoPlace
    if call.deadline <= now then fail(call, RpcError.Timeout(call.method, call.options.timeout))
    else if place != NoPlace then
      val _ = deadlines.add(call)
      assign(call, place)
    else
      refusal(call) match
        case Some(error) => fail(call, error)
        case None        =>
          val _ = deadlines.add(call)
          enqueue(call)

  def opened(connection: Int): Unit =
    val slot = connections(connection)
    slot.up = true
    slot.unreachable = None
    counters.connected.increment()
    effects.observe(RpcEvent.Connected(channel, connection))
    dispatch()

  def openFailed(connection: Int, reason: String): Unit =
    val slot = connections(connection)
    slot.unreachable = Some(reason)
    effects.observe(RpcEvent.ConnectFailed(channel, connection, reason))
    failWaiting(slot.keyed, reason)
    if connections.forall(_.unreachable.nonEmpty) then failWaiting(unkeyed, reason)
    retry(connection)

  /** An open connection has ended. `malformed` if because of what the peer sent. */
  def lost(connection: Int, reason: String, malformed: Boolean): Unit =
    val slot = connections(connection)
    slot.up = false
    counters.disconnected.increment()
    effects.observe(RpcEvent.Disconnected(channel, connection, reason))
    val stranded = slot.inFlight.values.toArray.sortBy(_.sequence)
    inFlight -= stranded.length
    slot.inFlight.clear()
    slot.abandoned.clear()
    for call <- stranded do
      val again = call.written && call.options.idempotent && call.sends <= settings.resends
      if again then
        counters.sentAgain.increment()
        effects.observe(RpcEvent.SentAgain(call.method, channel))
      if again || !call.written then
        call.connection = -1
        call.written = false
        enqueue(call)
      else if malformed then fail(call, RpcError.Malformed(call.method, reason))
      else fail(call, RpcError.ConnectionLost(address, mayHaveRun = true, reason))
    retry(connection)
    dispatch()

  /** Takes a reply. True if it answers a call of ours, late or in time. */
  def replied(connection: Int, reply: RpcMessage.Reply, now: Instant): Boolean =
    val slot = connections(connection)
    slot.inFlight.get(reply.id) match
      case Some(call) if call.written =>
        slot.inFlight.remove(call.id)
        inFlight -= 1
        slot.failures = 0
        if reply.error == Null then succeed(call, TimedReply(reply.result, call.sentAt, now))
        else fail(call, RpcError.Refused(call.method, RpcMessage.errorText(reply.error)))
        dispatch()
        true
      case _ =>
        slot.abandoned.remove(reply.id) match
          case Some(call) =>
            counters.late.increment()
            effects.observe(RpcEvent.LateReply(call.method, channel, connection, now.since(call.sentAt)))
            true
          case None =>
            counters.unexpected.increment()
            effects.observe(RpcEvent.UnexpectedReply(reply.id, channel, connection))
            false

  def ignored(connection: Int, what: String): Unit =
    counters.ignored.increment()
    effects.observe(RpcEvent.Ignored(what, channel, connection))

  /** Ends every call whose timeout has passed. */
  def expire(now: Instant): Unit =
    while !deadlines.isEmpty && deadlines.first.deadline <= now do
      val call = deadlines.first
      leave(call)
      fail(call, RpcError.Timeout(call.method, call.options.timeout))
    dispatch()

  /** Ends a call whose answer is no longer awaited; one that has ended is left alone. */
  def withdraw(call: Call, now: Instant): Unit = if !call.ended then
    leave(call)
    fail(call, RpcError.Timeout(call.method, now.since(call.calledAt)))
    dispatch()

  /** Ends every call with [[RpcError.Cancelled]]. */
  def close(): Unit =
    for call <- deadlines.asScala.toArray do
      leave(call)
      fail(call, RpcError.Cancelled(call.method))

  private def leave(call: Call): Unit =
    if call.connection < 0 then
      val _ = lineOf(call).remove(call)
      waiting -= 1
    else
      val slot = connections(call.connection)
      slot.inFlight.remove(call.id)
      inFlight -= 1
      if call.written then slot.remember(call)

  private def succeed(call: Call, answer: TimedReply[Msg | Received]): Unit =
    counters.answered.increment()
    finish(call, Right(answer))

  private def fail(call: Call, error: RpcError): Unit =
    counters.failed(error)
    effects.observe(RpcEvent.Failed(call.method, channel, error))
    finish(call, Left(error))

  private def finish(call: Call, outcome: Either[RpcError, TimedReply[Msg | Received]]): Unit =
    call.ended = true
    val _ = deadlines.remove(call)
    effects.end(call, outcome)

  private def retry(connection: Int): Unit =
    val slot = connections(connection)
    slot.failures += 1
    val pause = settings.backOff.pause(slot.failures, uniform())
    effects.reconnect(connection, pause)
    effects.observe(RpcEvent.Reconnecting(channel, connection, pause))

  private def failWaiting(line: TreeSet[Call], reason: String): Unit =
    while !line.isEmpty do
      waiting -= 1
      fail(line.pollFirst(), RpcError.Unreachable(address, reason))

  private def enqueue(call: Call): Unit =
    val _ = lineOf(call).add(call)
    waiting += 1

  private def lineOf(call: Call): TreeSet[Call] = call.options.key match
    case Some(key) => connections(connectionOf(key)).keyed
    case None      => unkeyed

  private def connectionOf(key: Int): Int = Math.floorMod(key, connections.length)

  /** The error of a call that finds the window full and may not wait; None if it may wait. */
  private def refusal(call: Call): Option[RpcError] =
    val candidates = call.options.key match
      case Some(key) => IndexedSeq(connections(connectionOf(key)))
      case None      => connections.toIndexedSeq
    if candidates.forall(_.unreachable.nonEmpty) then
      Some(RpcError.Unreachable(address, candidates.head.unreachable.get))
    else if call.options.whenFull == WhenFull.Refuse && candidates.exists(_.up) then
      Some(RpcError.Overloaded(
        call.method,
        if inFlight >= settings.windowInAll then fullInAll else fullPerConnection
      ))
    else if waiting >= settings.queue then
      Some(RpcError.Overloaded(call.method, s"${settings.queue} calls wait already"))
    else None

  private def fullInAll         = s"${settings.windowInAll} calls are in flight already"
  private def fullPerConnection =
    s"${settings.windowPerConnection} calls are in flight already on each connection"

  private def placeFor(call: Call): Int =
    if inFlight >= settings.windowInAll then NoPlace
    else
      call.options.key match
        case Some(key) => if hasPlace(connectionOf(key)) then connectionOf(key) else NoPlace
        case None      => leastLoaded

  private def hasPlace(connection: Int): Boolean =
    connections(connection).up && connections(connection).inFlight.size < settings.windowPerConnection

  private def leastLoaded: Int =
    Iterator
      .tabulate(connections.length)(i => (rotation + i) % connections.length)
      .filter(hasPlace)
      .minByOption(connections(_).inFlight.size)
      .getOrElse(NoPlace)

  private def assign(call: Call, connection: Int): Unit =
    val slot = connections(connection)
    if call.options.key.isEmpty then rotation = (connection + 1) % connections.length
    call.connection = connection
    call.id = slot.freshId()
    slot.inFlight(call.id) = call
    inFlight += 1
    effects.send(call)

  /** Sends waiting calls, oldest first, while there is room. */
  private def dispatch(): Unit =
    def next = if waiting > 0 then oldestWithPlace else None
    for call <- Iterator.continually(next).takeWhile(_.nonEmpty).flatten do
      val place = placeFor(call)
      val _     = lineOf(call).remove(call)
      waiting -= 1
      assign(call, place)

  private def oldestWithPlace: Option[Call] =
    val heads = (unkeyed +: connections.map(_.keyed)).iterator.filterNot(_.isEmpty).map(_.first)
    heads.filter(placeFor(_) != NoPlace).minByOption(_.sequence)

private object ChannelState:
  private val NoPlace = -1

  private val byDeadline: Comparator[Call] =
    Comparator.comparingLong[Call](_.deadline.toNanos).thenComparingLong(_.sequence)

  private def waitingLine(): TreeSet[Call] = TreeSet[Call](Comparator.comparingLong[Call](_.sequence))

  private final class Connection(rememberedIds: Int):
    var up          = false
    var unreachable = Option.empty[String]
    var failures    = 0
    val inFlight    = mutable.LongMap.empty[Call]
    val abandoned   = mutable.LinkedHashMap.empty[Long, Call]
    val keyed       = waitingLine()
    private var id  = 0L

    /** Draws the next id from a counter that wraps at 32 bits, skipping ids still in use. */
    def freshId(): Long =
      while inFlight.contains(id) || abandoned.contains(id) do id = (id + 1) & RpcMessage.MaxId
      val fresh = id
      id = (id + 1) & RpcMessage.MaxId
      fresh

    def remember(call: Call): Unit =
      abandoned(call.id) = call
      if abandoned.size > rememberedIds then
        val _ = abandoned.remove(abandoned.head._1)
