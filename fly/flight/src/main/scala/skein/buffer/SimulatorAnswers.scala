package skein.buffer

import org.apache.pekko.util.ByteString
import scala.collection.mutable.ArrayBuffer
import skein.rpc.{FrameLimits, Framed, Framer, RpcMessage}

/** Finds in what a simulator sends over one connection the ends of its messages, and the calls that they
  * answer. Mutable; does no I/O, and keeps a few bytes of each message.
  */
private[buffer] final class SimulatorAnswers:
  private val framer = new Framer(FrameLimits.Listening, SimulatorAnswers.KeptBytes)
  private var begun  = 0L // bytes of the message that is not complete
  private var lost   = false

  /** Whether the bytes are not understood any more. */
  def isLost: Boolean = lost

  /** Whether a message has begun and not ended: nothing may come between its bytes. */
  def isMidway: Boolean = lost || begun > 0

  /** Adds bytes, cut anywhere.
    *
    * @return the ids of messages that they complete, and where among them the last one ends; where none does,
    *   and one had begun before, no place
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
