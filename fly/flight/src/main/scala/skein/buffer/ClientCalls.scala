package skein.buffer

import org.apache.pekko.util.ByteString
import scala.collection.mutable.ArrayBuffer
import skein.rpc.{FrameLimits, Framed, Framer, RpcMessage}

/** A piece of a client's stream. The pieces in order are the whole stream, except for plans that are too
  * long.
  */
private[buffer] enum Piece:
  /** Bytes that pass: they concern no plan, or are not understood. */
  case Rest(bytes: ByteString)

  /** A call that concerns the buffer.
    *
    * @param id absent for a notification, and for a long call whose answer is not tracked
    */
  case Call(wish: Wish, id: Option[Long], bytes: ByteString)

/** Splits one client's stream into the calls that concern the buffer, and everything else. Mutable; does no
  * I/O.
  *
  * A message is held until it is complete or has [[Wish.MostBytes]]. A longer one passes as it arrives,
  * except for a plan, which is removed. From the first byte that is not MessagePack on, everything passes.
  */
private[buffer] final class ClientCalls:
  import ClientCalls.*
  import Wish.MostBytes

  private val framer           = new Framer(FrameLimits.Listening, MostBytes)
  private var held             = ByteString.empty // of the message that is not complete
  private var gone             = 0L               // bytes of it before these
  private var current: Current = Current.Held
  private var lost             = false

  /** Whether the bytes are no longer understood. */
  def isLost: Boolean = lost

  /** Lets everything pass from now on.
    *
    * @return the held bytes that may pass
    */
  def giveUp(): ByteString =
    val rest = current match
      case Current.Taken(_, _) => ByteString.empty
      case _                   => held
    held = ByteString.empty
    lost = true
    rest

  /** Adds bytes, cut anywhere; returns the pieces that they complete. */
  def offer(bytes: ByteString): Vector[Piece] =
    if lost then Vector(Piece.Rest(bytes))
    else
      val pieces = ArrayBuffer.empty[Piece]
      held = held ++ bytes
      framer.offer(bytes)
      var more = true
      while more do
        framer.next() match
          case Framed.Complete(frame) =>
            val (message, after) = held.splitAt((framer.valueBytes - gone).toInt)
            pieces += complete(frame, message)
            held = after
            gone = 0
            current = Current.Held
          case Framed.NeedsMore =>
            if current == Current.Held && held.size >= MostBytes then pieces ++= begin()
            if current != Current.Held then
              if current == Current.Passes then pieces += Piece.Rest(held)
              gone += held.size
              held = ByteString.empty
            more = false
          case Framed.Malformed(_) =>
            pieces += Piece.Rest(giveUp())
            more = false
      pieces.toVector

  private def complete(frame: Array[Byte], message: ByteString): Piece = current match
    case Current.Passes          => Piece.Rest(message)
    case Current.Taken(wish, id) => Piece.Call(wish, id, ByteString.empty)
    case Current.Held            =>
      val call =
        if message.size > MostBytes then long(message)
        else
          RpcMessage.fromClient(frame) match
            case RpcMessage.Request(id, method, params) =>
              Wish.of(method, params).map(Piece.Call(_, Some(id), message))
            case RpcMessage.Notification(method, params) =>
              Wish.of(method, params).map(Piece.Call(_, None, message))
            case _ => None
      call.getOrElse(Piece.Rest(message))

  /** Decides on a long message by its held beginning. */
  private def begin(): Option[Piece] = long(held) match
    case Some(Piece.Call(wish: Wish.Plan, id, _)) =>
      current = Current.Taken(wish, id)
      None
    case other =>
      current = Current.Passes
      gone += held.size
      val beginning = other.getOrElse(Piece.Rest(held))
      held = ByteString.empty
      Some(beginning)

  private def long(message: ByteString): Option[Piece] =
    for
      (id, method) <- RpcMessage.headOf(message.take(HeadBytes).toArray)
      wish         <- Wish.ofLong(method)
    yield wish match
      case plan: Wish.Plan => Piece.Call(plan, id, ByteString.empty)
      case other           => Piece.Call(other, None, message)

private object ClientCalls:
  private val HeadBytes = 1024

  /** The treatment of the message that is still incomplete. */
  private enum Current:
    case Held
    case Passes
    case Taken(wish: Wish, id: Option[Long])
