package skein.observe

import org.apache.pekko.util.ByteString
import skein.rpc.{FrameLimits, Framed, Framer, MessageReader, Received, RpcMessage}
import skein.units.Instant
import upack.{Msg, Str}

/** Parses the bytes of one connection. Mutable; one thread at a time.
  *
  * Memory: the first 64 KiB of a message in each direction. The rest of a longer one, such as an image, is
  * only counted.
  */
final class Conversation(connection: Int):
  import Conversation.*

  private val calls, answers = Side()

  /** Parses bytes from the client, split anywhere. */
  def fromClient(bytes: ByteString, at: Instant): Vector[Passed] = calls.read(bytes, at): frame =>
    RpcMessage.fromClient(frame) match
      case RpcMessage.Request(id, method, params) =>
        Some(Passed.Called(connection, id, method, vehicleOf(method, params), at))
      case _ => None

  /** Parses bytes from the simulator, split anywhere. */
  def fromSimulator(bytes: ByteString, at: Instant): Vector[Passed] = answers.read(bytes, at): frame =>
    RpcMessage.fromServerUnread(frame) match
      case RpcMessage.Reply(id, error, result) =>
        val failed = Option.when(error != upack.Null)(RpcMessage.errorText(error))
        Some(Passed.Answered(connection, id, failed, stampOf(result), answers.length, at))
      case _ => None

  /** Whether a direction could not be parsed: the other alone would say which calls are awaited, or answered.
    */
  private var isLost = false

  /** The parser of one direction of the connection. */
  private final class Side:
    private val framer = new Framer(FrameLimits.Listening, KeptBytes)

    def length: Long = framer.valueBytes

    def read(bytes: ByteString, at: Instant)(meaning: Array[Byte] => Option[Passed]): Vector[Passed] =
      if isLost then Vector.empty
      else
        framer.offer(bytes)
        Vector
          .unfold(framer.next()):
            case Framed.Complete(frame)   => Some((meaning(frame), framer.next()))
            case Framed.Malformed(reason) =>
              Option.when(!isLost):
                isLost = true
                (Some(Passed.Unreadable(connection, reason, at)), Framed.NeedsMore)
            case Framed.NeedsMore => None
          .flatten

object Conversation:
  private val KeptBytes = 64 << 10

  /** The vehicle's name: the last parameter, unless a flag or a camera's settings follow it. */
  private def vehicleOf(method: String, params: IndexedSeq[Msg]): String =
    val place = method match
      case "simGetImages"                                              => 1
      case "simGetImage" | "simGetDetections" | "simGetDetectedObject" => 2
      case "simGetObjectPose"                                          => 0
      case _                                                           => params.size - 1
    params.lift(place).collect { case Str(name) => name }.getOrElse("")

  /** The time stamp of an answer: `timestamp` in states, `time_stamp` in sensors. */
  private def stampOf(result: Msg | Received): Option[Instant] = result match
    case received: Received =>
      var stamp = Option.empty[Instant]
      val read  = MessageReader.read(received): reader =>
        reader.fields { case "timestamp" | "time_stamp" => stamp = Some(Instant.ofNanos(reader.long())) }
      read.toOption.flatMap(_ => stamp).filter(_.toNanos > 0)
    case _ => None
