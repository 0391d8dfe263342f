package skein.view

import java.nio.{BufferUnderflowException, ByteBuffer, ByteOrder}
import java.nio.charset.StandardCharsets.UTF_8
import org.apache.pekko.util.{ByteString, ByteStringBuilder}
import scala.util.control.NonFatal
import skein.record.Topic
import skein.units.Instant

/** A topic with its channel number on a connection. */
final case class FoxgloveChannel(id: Long, topic: Topic)

/** A viewer's message. Viewers choose the numbers of subscriptions, the server those of channels. */
enum ClientMessage:
  case Subscribe(subscriptions: Vector[(subscription: Long, channel: Long)])
  case Unsubscribe(subscriptions: Vector[Long])

  /** Controls playback: whether to play, how fast, and from where.
    *
    * @param speed recorded seconds per second
    * @param request identifies the answer
    */
  case Playback(playing: Boolean, speed: Double, seek: Option[Instant], request: String)

  /** A message of the protocol that this server does not support. */
  case NotOffered(op: String)

/** Foxglove's WebSocket protocol: pure, bytes and texts in and out.
  *
  * Source: `foxglove/ws-protocol`, docs/spec.md, and for playback the WebSocket server of the Foxglove SDK.
  * Binary messages are little-endian.
  */
object Protocol:

  /** Supported subprotocols, in order of preference. */
  val Names: Vector[String] = Vector("foxglove.sdk.v1", "foxglove.websocket.v1")

  /** The state of playback.
    *
    * @param speed recorded seconds per second
    * @param seeked whether the time has jumped
    * @param request identifier of the request that this answers; empty without one
    */
  final case class Playing(status: Status, now: Instant, speed: Double, seeked: Boolean, request: String)

  enum Status:
    case Playing, Paused, Buffering, Ended

  /** The first message to every viewer.
    *
    * @param recorded begin and end of a recording that can be played; None during a flight
    * @param session differs after a restart
    */
  def serverInfo(name: String, session: String, recorded: Option[(Instant, Instant)]): String =
    val info = ujson.Obj(
      "op"           -> "serverInfo",
      "name"         -> name,
      "capabilities" -> ujson.Arr.from(Seq("time") ++ recorded.map(_ => "playbackControl")),
      "metadata"     -> ujson.Obj(),
      "sessionId"    -> session
    )
    for (start, end) <- recorded do
      info("dataStartTime") = time(start)
      info("dataEndTime") = time(end)
    info.render()

  def advertise(channels: Seq[FoxgloveChannel]): String = ujson.Obj(
    "op"       -> "advertise",
    "channels" -> ujson.Arr.from(channels.map(channel =>
      ujson.Obj(
        "id"             -> channel.id.toDouble,
        "topic"          -> channel.topic.name,
        "encoding"       -> (if channel.topic.isBinary then "protobuf" else "json"),
        "schemaName"     -> channel.topic.schemaName,
        "schema"         -> channel.topic.schema,
        "schemaEncoding" -> (if channel.topic.isBinary then "protobuf" else "jsonschema")
      )
    ))
  ).render()

  /** A line for a person. A later one with this `id` replaces it. */
  def warning(id: String, text: String): String =
    ujson.Obj("op" -> "status", "level" -> 1, "message" -> text, "id" -> id).render()

  def messageData(subscription: Long, logTime: Instant, payload: ByteString): ByteString =
    binary(1)(_.putInt(subscription.toInt).putLong(logTime.toNanos)) ++ payload

  def time(now: Instant, op: Byte): ByteString = binary(op)(_.putLong(now.toNanos))

  def timeIs(now: Instant): ByteString = time(now, 2)

  def playbackState(state: Playing): ByteString =
    val request = state.request.getBytes(UTF_8)
    binary(5)(
      _.putByte(state.status.ordinal.toByte)
        .putLong(state.now.toNanos)
        .putFloat(state.speed.toFloat)
        .putByte(if state.seeked then 1 else 0)
        .putInt(request.length)
        .putBytes(request)
    )

  /** Parses a viewer's text message.
    *
    * @return Left says what was wrong with it
    */
  def read(text: String): Either[String, ClientMessage] =
    try
      val message = ujson.read(text)
      message("op").str match
        case "subscribe" =>
          Right(ClientMessage.Subscribe(
            message("subscriptions").arr.toVector.map(one => (number(one("id")), number(one("channelId"))))
          ))
        case "unsubscribe" =>
          Right(ClientMessage.Unsubscribe(message("subscriptionIds").arr.toVector.map(number)))
        case op => Right(ClientMessage.NotOffered(op.take(64)))
    catch
      case refused: Malformed                  => Left(refused.getMessage)
      case NonFatal(_) | _: StackOverflowError =>
        Left("expected a JSON object with a known op and its fields")

  def read(bytes: ByteString): Either[String, ClientMessage] =
    val in = bytes.toByteBuffer.order(ByteOrder.LITTLE_ENDIAN)
    try
      in.get() match
        case 3  => playback(in)
        case op => Right(ClientMessage.NotOffered(s"binary $op"))
    catch
      case _: BufferUnderflowException =>
        Left(s"a binary message ends at byte ${bytes.length}, within a field")

  private def playback(in: ByteBuffer): Either[String, ClientMessage] =
    val command = in.get()
    val speed   = in.getFloat()
    val hasSeek = in.get() != 0
    val seek    = in.getLong()
    val length  = in.getInt()
    if command != 0 && command != 1 then Left(s"a playback command is 0 or 1, got $command")
    else if !(speed > 0 && speed <= Playback.MostSpeed) then
      Left(s"a playback speed is more than 0 and up to ${Playback.MostSpeed.toInt}, got $speed")
    else if length < 0 || length > in.remaining || length > MostRequest then
      Left(s"a request's name has up to $MostRequest bytes, all of them in the message; got $length")
    else
      val request = new Array[Byte](length)
      in.get(request)
      Right(ClientMessage.Playback(
        command == 0,
        speed,
        Option.when(hasSeek)(Instant.ofNanos(seek)),
        String(request, UTF_8)
      ))

  private val MostRequest = 256
  private val MostNumber  = 0xffffffffL

  private final class Malformed(message: String) extends RuntimeException(message, null, false, false)

  private def number(value: ujson.Value): Long =
    val number = value.num
    if number >= 0 && number <= MostNumber && number == number.toLong then number.toLong
    else
      throw Malformed(
        s"a number of a channel or a subscription is whole, from 0 to $MostNumber; got $number"
      )

  private def time(at: Instant) =
    ujson.Obj(
      "sec"  -> (at.toNanos / 1_000_000_000L).toDouble,
      "nsec" -> (at.toNanos % 1_000_000_000L).toDouble
    )

  private given ByteOrder = ByteOrder.LITTLE_ENDIAN

  private def binary(op: Byte)(fields: ByteStringBuilder => ByteStringBuilder): ByteString =
    fields(ByteString.newBuilder.putByte(op)).result()
