package skein.buffer

import org.apache.pekko.util.ByteString
import scala.collection.mutable.ArrayBuffer
import skein.rpc.{FrameLimits, Framed, Framer, RpcMessage}

/** Finds the ends of messages in one connection's stream from the simulator, and the calls that they answer.
  * Mutable; does no I/O, and keeps a few bytes of each message.
  */
private[buffer] final class SimulatorAnswers:
  private val framer = new Framer(FrameLimits.Listening, SimulatorAnswers.KeptBytes)
  private var begun  = 0L // bytes of the message that is not complete
  private var lost   = false

  /** Whether the bytes are no longer understood. */
  def isLost: Boolean = lost

  /** Whether nothing may be inserted now: a message is incomplete, or the bytes are no longer understood. */
  def isMidway: Boolean = lost || begun > 0

  /** Adds bytes, cut anywhere.
    *
    * @return the ids of the completed messages, and the last position in these bytes between two messages, if
    *   there is one
    */
  def offer(bytes: ByteString): (ids: Vector[Long], end: Option[Int]) =
    val ids = ArrayBuffer.empty[Long]
    var end = Option.when(!isMidway)(0)
    if !lost then
      framer.offer(bytes)
      var at   = 0
      var more = true
      while more do
        framer.next() match
          case Framed.Complete(frame) =>
            at += (framer.valueBytes - begun).toInt
            begun = 0
            end = Some(at)
            ids ++= RpcMessage.idIn(frame)
          case Framed.NeedsMore =>
            begun += bytes.size - at
            more = false
          case Framed.Malformed(_) =>
            lost = true
            more = false
    (ids = ids.toVector, end = end)

private object SimulatorAnswers:
  private val KeptBytes = 64
