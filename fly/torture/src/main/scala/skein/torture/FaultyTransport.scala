package skein.torture

import org.apache.pekko.NotUsed
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Flow, Source}
import org.apache.pekko.util.ByteString
import scala.collection.mutable
import scala.concurrent.Future
import skein.link.*
import skein.rpc.{Framed, Framer, RpcMessage}
import skein.signal.SplitMix64
import skein.units.*
import upack.{Arr, Float64, Int32, Msg, Null, Str}

/** A move on arrival at the simulator, with the velocity in the message. */
final case class ReceivedMove(at: Instant, vehicle: String, north: Float, east: Float)

/** The simulator's transport with an interceptor that records every move in the order of arrival, and until
  * `calm` applies [[MessageFaults]] to messages. Connections from `spared` are not affected.
  */
final class FaultyTransport(
    transport: Transport,
    messageFaults: MessageFaults,
    spared: String,
    seed: Long,
    clock: Clock,
    calm: Instant
)(using system: ActorSystem)
    extends Transport:
  import FaultyTransport.*
  import system.dispatcher

  private val random     = SplitMix64(seed)
  private val arrived    = mutable.ArrayBuffer.empty[ReceivedMove]
  private val hovers     = mutable.Map.empty[String, Instant]
  private val unanswered = mutable.Map.empty[String, Int].withDefaultValue(0)
  private var most       = 0

  def arrivals: Vector[ReceivedMove] = arrived.toVector

  /** When each vehicle last received a command to hover. */
  def lastHovers: Map[String, Instant] = hovers.toMap

  /** The largest number of simultaneously unanswered moves of one vehicle. */
  def mostUnanswered: Int = most

  def connect(to: Address): Flow[ByteString, ByteString, Future[org.apache.pekko.Done]] =
    transport.connect(to)

  def listen(at: Address): Source[Incoming, Future[Listening]] =
    transport.listen(at).map: incoming =>
      if incoming.from.host == spared then incoming else incoming.copy(flow = tapped(incoming.flow))

  private def tapped(client: Flow[ByteString, ByteString, NotUsed]): Flow[ByteString, ByteString, NotUsed] =
    val moves = mutable.LongMap.empty[String]
    val tap   = Flow.fromFunction[Array[Byte], ByteString](request(moves, _))
    val ended = Flow[ByteString].watchTermination(): (_, done) =>
      // Pending calls of a closed connection receive no answer.
      done.onComplete(_ => moves.values.foreach(unanswered(_) -= 1))
      NotUsed
    Flow[ByteString].via(replies(moves)).via(client).via(frames).via(tap).via(ended)

  private def request(moves: mutable.LongMap[String], frame: Array[Byte]): ByteString =
    RpcMessage.fromClient(frame) match
      case RpcMessage.Request(id, method, params) if Moves(method) && params.nonEmpty =>
        if meddles(messageFaults.refused) then renamed(method, frame)
        else
          val vehicle       = textOf(params.last)
          val (north, east) = params match
            case Float64(north) +: Float64(east) +: _ if ByVelocity(method) => (north, east)
            case _                                                          => (0.0, 0.0)
          arrived += ReceivedMove(clock.now(), vehicle, north.toFloat, east.toFloat)
          moves(id) = vehicle
          unanswered(vehicle) += 1
          most = most.max(unanswered(vehicle))
          ByteString.fromArrayUnsafe(frame)
      case RpcMessage.Request(_, Hover, params) =>
        params.lastOption.foreach(vehicle => hovers(textOf(vehicle)) = clock.now())
        ByteString.fromArrayUnsafe(frame)
      case _ => ByteString.fromArrayUnsafe(frame)

  private def replies(moves: mutable.LongMap[String]): Flow[ByteString, ByteString, NotUsed] =
    Flow[ByteString]
      .via(frames)
      .mapConcat: frame =>
        RpcMessage.fromServer(frame) match
          case RpcMessage.Reply(id, _, _) =>
            moves.remove(id).foreach(unanswered(_) -= 1)
            mischief(id, ByteString.fromArrayUnsafe(frame))
          case _ => Vector(ByteString.fromArrayUnsafe(frame))
      .mapAsyncUnordered(HeldBack): frame =>
        if meddles(messageFaults.late) then
          after(upTo(messageFaults.lateBy).toDuration, system.scheduler)(Future.successful(frame))
        else Future.successful(frame)

  private def mischief(id: Long, reply: ByteString): Vector[ByteString] =
    if meddles(messageFaults.lost) then Vector.empty
    else if meddles(messageFaults.doubled) then Vector(reply, reply)
    else if meddles(messageFaults.nonsense) then
      Vector(encoded(Arr(Int32(1), number(id), Null, Str("nonsense"))))
    else if meddles(messageFaults.garbage) then Vector(ByteString(0xc1), reply)
    else if meddles(messageFaults.stray) then
      val strays = Vector[Msg](
        Int32(7),
        Str("hello"),
        Arr(Int32(1), Int32(2)),
        Arr(Int32(1), number(id + 1_000_000), Null, Null)
      )
      Vector(encoded(strays(random.nextInt(strays.size))), reply)
    else Vector(reply)

  private def meddles(probability: Double): Boolean =
    probability > 0 && clock.now() < calm && random.nextDouble() < probability

  private def upTo(most: Span): Span = Span.ofNanos((random.nextDouble() * most.toNanos).toLong)

private object FaultyTransport:
  private val ByVelocity = Set("moveByVelocityZ", "moveByVelocity")

  /** Methods that command a vehicle, except hovering. */
  private val Moves =
    ByVelocity ++ Set(
      "moveToPosition",
      "rotateToYaw",
      "rotateByYawRate",
      "moveByRollPitchYawThrottle",
      "land"
    )

  private val Hover = "hover"

  /** Maximum number of answers that one connection holds back simultaneously. */
  private val HeldBack = 1024

  /** Splits a stream of bytes into messages. */
  private def frames: Flow[ByteString, Array[Byte], NotUsed] =
    Flow[ByteString].statefulMap(() => new Framer())(
      (framer, bytes) =>
        framer.offer(bytes)
        (
          framer,
          Vector.unfold(framer)(framer =>
            framer.next() match
              case Framed.Complete(frame)   => Some((frame, framer))
              case Framed.NeedsMore         => None
              case Framed.Malformed(reason) => throw IllegalStateException(reason)
          )
        )
      ,
      _ => None
    ).mapConcat(identity)

  /** A request with another last letter in its method's name. */
  private def renamed(method: String, frame: Array[Byte]): ByteString =
    val at = frame.indexOfSlice(method.getBytes) + method.length - 1
    ByteString.fromArrayUnsafe(frame.updated(at, 'Q'.toByte))

  private def encoded(message: Msg): ByteString = ByteString.fromArrayUnsafe(upack.write(message))

  private def number(id: Long): Msg = upack.Int64(id)

  private def textOf(value: Msg): String = value match
    case Str(text) => text
    case other     => other.toString
