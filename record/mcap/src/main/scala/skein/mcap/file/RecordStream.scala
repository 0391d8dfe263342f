package skein.mcap.file

import java.nio.ByteBuffer
import java.nio.channels.ReadableByteChannel
import skein.mcap.{McapError, McapLimits, Parsed, Record, StreamParser, TopicMessage}

/** The records of a source that can be read once, from its start, such as a pipe or a socket. It ends after
  * an error. Reading blocks while the channel does, and throws its `IOException`.
  */
final class RecordStream(channel: ReadableByteChannel, limits: McapLimits = McapLimits())
    extends Iterator[Either[McapError, Parsed.Found]]:
  private val parser = StreamParser(limits)
  private val piece  = ByteBuffer.allocate(RecordStream.Piece)
  private var ahead  = Option.empty[Either[McapError, Parsed.Found]]
  private var ended  = false

  def schema(id: Int): Option[Record.Schema] = parser.schema(id)

  def channel(id: Int): Option[Record.Channel] = parser.channel(id)

  def hasNext: Boolean =
    while ahead.isEmpty && !ended do
      parser.next() match
        case found: Parsed.Found  => ahead = Some(Right(found))
        case Parsed.NeedsBytes    => refill()
        case Parsed.Ended         => ended = true
        case Parsed.Failed(error) =>
          ahead = Some(Left(error))
          ended = true
    ahead.isDefined

  def next(): Either[McapError, Parsed.Found] =
    if !hasNext then throw java.util.NoSuchElementException("no more records")
    val found = ahead.get
    ahead = None
    found

  /** Only the messages, with their channels and schemas. */
  def messages: Iterator[Either[McapError, TopicMessage]] = collect:
    case Right(Parsed.Found(message: Record.Message, _, _)) =>
      // The parser refuses a message of a channel that is not known.
      val channel = parser.channel(message.channelId).get
      Right(TopicMessage(channel, parser.schema(channel.schemaId), message))
    case Left(error) => Left(error)

  private def refill(): Unit =
    piece.clear()
    val count = channel.read(piece)
    if count < 0 then parser.end() else parser.offer(piece.array, 0, count)

object RecordStream:
  private val Piece = 1 << 20
