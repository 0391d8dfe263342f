package skein.rpc

import scala.util.control.NonFatal
import upack.{Arr, Binary, Int32, Int64, Msg, Null, Obj, Str, UInt64}

/** One MessagePack-RPC message, decoded.
  *
  * Requests are `[0, id, method, params]`, replies `[1, id, error, result]`, notifications `[2, method,
  * params]`. Which of them an array is follows from its length and the role of the reader; the type field is
  * not checked, as AirSim's server does not check it either.
  */
enum RpcMessage:
  case Request(id: Long, method: String, params: IndexedSeq[Msg])
  case Notification(method: String, params: IndexedSeq[Msg])
  case Reply(id: Long, error: Msg, result: Msg | Received)

  /** A value that is not a message but is harmless: an array of another length, a map, a number. */
  case Ignored(what: String)

  /** A value that cannot be answered safely; its connection is to be closed. */
  case Malformed(reason: String)

object RpcMessage:
  val MaxId: Long = 0xffffffffL

  def fromClient(frame: Array[Byte]): RpcMessage = decode(frame):
    case Arr(fields) =>
      fields.length match
        case 4 =>
          for
            id     <- idOf(fields(1))
            method <- methodOf(fields(2))
            params <- paramsOf(fields(3))
          yield Request(id, method, params)
        case 3 =>
          for
            method <- methodOf(fields(1))
            params <- paramsOf(fields(2))
          yield Notification(method, params)
        case length => Right(Ignored(s"an array of $length"))
    case other => Right(Ignored(kindOf(other)))

  /** The id of a request or a reply of which only the beginning is known. */
  private[skein] def idIn(beginning: Array[Byte]): Option[Long] = headIn(beginning)((id, _) => id)

  /** Id and method of a request of which only the beginning is known; without an id, of a notification. */
  private[skein] def headOf(beginning: Array[Byte]): Option[(id: Option[Long], method: String)] =
    headIn(beginning)((id, rest) => Some((id = id, method = rest.string())))

  /** Reads what follows the type, without decoding the rest. */
  private def headIn[A](beginning: Array[Byte])(read: (Option[Long], MessageReader) => Option[A]): Option[A] =
    val reader = MessageReader.of(beginning)
    MessageReader.attempt:
      val length = reader.array()
      reader.skip()
      if length == 4 then read(Some(reader.long()), reader)
      else if length == 3 then read(None, reader)
      else None
    .toOption.flatten

  def fromServer(frame: Array[Byte]): RpcMessage = decode(frame):
    case Arr(fields) if fields.length == 4 => idOf(fields(1)).map(Reply(_, fields(2), fields(3)))
    case Arr(fields)                       => Right(Ignored(s"an array of ${fields.length}"))
    case other                             => Right(Ignored(kindOf(other)))

  /** Decodes one value received by a client, but leaves a reply's result undecoded, so that a large one needs
    * no tree.
    */
  def fromServerUnread(frame: Array[Byte]): RpcMessage =
    val reader = MessageReader.of(frame)
    try
      if !reader.isArray then Ignored("no array")
      else
        reader.array() match
          case 4 =>
            reader.skip()
            idOf(upack.read(reader.raw())).fold(Malformed(_), Reply(_, upack.read(reader.raw()), reader.rest))
          case length => Ignored(s"an array of $length")
    catch case NonFatal(e) => Malformed(s"not readable as MessagePack: $e")

  /** The text of a reply's error slot, shortened for display. */
  def errorText(error: Msg): String = error match
    case Str(text)   => short(text)
    case Binary(raw) => short(utf8(raw))
    case other       => s"an error that is no text but ${kindOf(other)}"

  private def short(text: String): String =
    if text.length <= LongestError then text
    else s"${text.take(LongestError)}… (${text.length} characters)"

  private val LongestError = 4000

  private def decode(frame: Array[Byte])(meaning: Msg => Either[String, RpcMessage]): RpcMessage =
    try meaning(upack.read(frame, trace = false)).fold(Malformed(_), identity)
    catch case NonFatal(e) => Malformed(s"not readable as MessagePack: $e")

  private def idOf(field: Msg): Either[String, Long] = field match
    case Int32(id) if id >= 0                 => Right(id.toLong)
    case Int64(id) if id >= 0 && id <= MaxId  => Right(id)
    case UInt64(id) if id >= 0 && id <= MaxId => Right(id)
    case Int32(id)                            => Left(s"a negative id: $id")
    case Int64(id)                            => Left(s"an id outside 0 to 2^32 - 1: $id")
    case UInt64(id) => Left(s"an id outside 0 to 2^32 - 1: ${java.lang.Long.toUnsignedString(id)}")
    case other      => Left(s"an id that is ${kindOf(other)}")

  private def methodOf(field: Msg): Either[String, String] = field match
    case Str(name)   => Right(name)
    case Binary(raw) => Right(utf8(raw))
    case other       => Left(s"a method name that is ${kindOf(other)}")

  private def paramsOf(field: Msg): Either[String, IndexedSeq[Msg]] = field match
    case Arr(params)                     => Right(params.toIndexedSeq)
    case Null                            => Right(IndexedSeq.empty)
    case Obj(entries) if entries.isEmpty => Right(IndexedSeq.empty)
    case other                           => Left(s"params that are ${kindOf(other)}")

  private def utf8(raw: Array[Byte]): String = String(raw, java.nio.charset.StandardCharsets.UTF_8)

  private[rpc] def kindOf(value: Msg): String = value match
    case _: Arr                             => "an array"
    case _: Obj                             => "a map"
    case _: Str                             => "a string"
    case _: Binary                          => "binary"
    case Null                               => "nil"
    case _: (Int32 | Int64 | UInt64)        => "an integer"
    case _: (upack.Float32 | upack.Float64) => "a float"
    case _: upack.Bool                      => "a boolean"
    case _: upack.Ext                       => "an extension"
