package skein.mcap

import java.io.ByteArrayOutputStream

/** A parser's results for a whole file. */
final case class Parsing(found: Vector[Parsed.Found], end: Parsed):
  def records: Vector[Record]          = found.map(_.record)
  def messages: Vector[Record.Message] = records.collect { case message: Record.Message => message }

object Parsing:
  /** @param piece number of bytes offered at a time */
  def all(file: Bytes, piece: Int = 1 << 20, limits: McapLimits = McapLimits()): Parsing =
    val parser = StreamParser(limits)
    val array  = file.toArray
    val found  = Vector.newBuilder[Parsed.Found]
    var at     = 0
    var end    = Option.empty[Parsed]
    while end.isEmpty do
      parser.next() match
        case record: Parsed.Found                    => found += record
        case Parsed.NeedsBytes if at == array.length => parser.end()
        case Parsed.NeedsBytes                       =>
          val until = (at + piece).min(array.length)
          parser.offer(array, at, until)
          at = until
        case other => end = Some(other)
    Parsing(found.result(), end.get)

final class MemorySink extends ByteSink:
  private val gathered = ByteArrayOutputStream()

  def write(array: Array[Byte], from: Int, until: Int): Unit = gathered.write(array, from, until - from)
  def bytes: Bytes                                           = Bytes.of(gathered.toByteArray)
