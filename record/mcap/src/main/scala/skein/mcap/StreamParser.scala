package skein.mcap

import java.util.Arrays
import java.util.zip.CRC32

/** The result of [[StreamParser.next]]. */
enum Parsed:

  /** @param length size of the whole record, bytes, including its kind and length, at its position */
  case Found(record: Record, at: Place, length: Long)

  /** All offered bytes are used: offer more, or declare the end. */
  case NeedsBytes

  /** The file is complete, and all its CRCs are right. */
  case Ended

  /** Nothing more can be read; after `CutOff`, everything before the cut was read. */
  case Failed(error: McapError)

/** Reads a file from its start to its end, in pieces of any size: bytes in, records out, no I/O of its own.
  *
  * A chunk is returned as a record and then as its records, one by one. Every CRC is verified: of chunks,
  * attachments, the data section and the summary. A truncated file yields everything before the cut, also of
  * a truncated chunk, whose CRC cannot be verified; then `CutOff`. Misplaced records, undefined references
  * and conflicting definitions are refused. Memory: one record, and one chunk's records uncompressed, both
  * within the limits; memory for a record grows with its bytes, at most 4 MiB ahead of them.
  *
  * For one thread at a time.
  */
final class StreamParser(limits: McapLimits = McapLimits()):
  import StreamParser.*

  private val known     = Catalogue()
  private var input     = Array.emptyByteArray
  private var from      = 0
  private var until     = 0
  private var noMore    = false
  private var phase     = Phase.Start
  private var start     = 0L
  private val head      = new Array[Byte](9)
  private var headHas   = 0
  private var content   = Array.emptyByteArray
  private var has       = 0
  private var length    = 0
  private var section   = Section.Header
  private var summaryAt = 0L
  private val sum       = CRC32()
  private var walk      = Option.empty[RecordWalk]
  private var last      = Option.empty[Parsed]

  def schema(id: Int): Option[Record.Schema] = known.schema(id)

  def channel(id: Int): Option[Record.Channel] = known.channel(id)

  /** Passes the next part of the file after `NeedsBytes`. The parser keeps the array until it needs bytes
    * again.
    */
  def offer(bytes: Array[Byte], start: Int, end: Int): Unit =
    require(from == until && !noMore, "offered before it was needed")
    require(0 <= start && start <= end && end <= bytes.length, s"bytes $start until $end of ${bytes.length}")
    input = bytes
    from = start
    until = end

  def offer(bytes: Array[Byte]): Unit = offer(bytes, 0, bytes.length)

  def end(): Unit = noMore = true

  def next(): Parsed =
    if walk.isEmpty && last.isDefined then last.get
    else
      try
        var found = Option.empty[Parsed]
        while found.isEmpty do found = fromChunk().orElse(last).orElse(advance())
        found.get
      catch
        case refused: Refused =>
          walk = None
          fail(refused.error)

  private def fail(error: McapError): Parsed =
    last = Some(Parsed.Failed(error))
    last.get

  private def fromChunk(): Option[Parsed] =
    walk.flatMap: records =>
      var found = Option.empty[Parsed]
      while found.isEmpty && records.step() do
        val at = records.place
        if !Opcode.isOfChunk(records.opcode) then
          Refused.malformed(at, "a record of a chunk", s"a ${Opcode.name(records.opcode)} record")
        val record = records.record
        if known.takes(record, at) then found = Some(Parsed.Found(record, at, records.length))
      if found.isEmpty then walk = None
      found

  private def advance(): Option[Parsed] = phase match
    case Phase.Start => magic(Phase.Head)
    case Phase.Head  => if fillHead(9) then { begin(); None }
      else short("9 bytes of a record's kind and length", headHas)
    case Phase.Content  => if fillContent() then finishRecord() else cutRecord()
    case Phase.EndMagic => magic(Phase.End)
    case Phase.End      =>
      if from < until then Refused.malformed(Place(start), "the end of the file", "more bytes")
      else if noMore then
        last = Some(Parsed.Ended)
        last
      else Some(Parsed.NeedsBytes)

  private def opcode = head(0) & 0xff

  private def short(expected: String, came: Long): Option[Parsed] =
    if noMore then throw Refused(McapError.CutOff(Place(start), expected, came)) else Some(Parsed.NeedsBytes)

  private def fillHead(count: Int): Boolean =
    val taken = (count - headHas).min(until - from)
    System.arraycopy(input, from, head, headHas, taken)
    from += taken
    headHas += taken
    headHas == count

  private def magic(next: Phase): Option[Parsed] =
    val whole = fillHead(Magic.bytes.size)
    val came  = Bytes.of(Arrays.copyOf(head, headHas))
    if came != Magic.bytes.slice(0, headHas) then
      if phase == Phase.Start then throw Refused(McapError.NotMcap(came))
      else Refused.malformed(Place(start), "MCAP's 8 bytes at the end of the file", "others")
    else if whole then
      if phase == Phase.Start then sum.update(head, 0, headHas)
      start += headHas
      headHas = 0
      phase = next
      None
    else if noMore && phase == Phase.Start && headHas == 0 then throw Refused(McapError.NotMcap(came))
    else short("MCAP's 8 bytes", headHas)

  private def begin(): Unit =
    val claimed = (1 to 8).foldRight(0L)((at, value) => value << 8 | head(at) & 0xffL)
    val name    = Opcode.name(opcode)
    section.hold(opcode, Place(start))
    limits.hold(claimed, limits.recordBytes, s"a $name record", Place(start))
    length = claimed.toInt
    content = new Array[Byte](length.min(Ahead))
    has = 0
    phase = Phase.Content

  private def fillContent(): Boolean =
    var going = true
    while going do
      val taken = (content.length - has).min(until - from)
      System.arraycopy(input, from, content, has, taken)
      from += taken
      has += taken
      if has == content.length && has < length && from < until then
        content = Arrays.copyOf(content, (has * 2L).min(length).toInt)
      else going = false
    has == length

  private def finishRecord(): Option[Parsed] =
    val at     = Place(start)
    val record = RecordCodec.decode(opcode, content, 0, length, at)
    record match
      case Record.DataEnd(crc) =>
        Checksum.hold(crc, sum.getValue.toInt, "all bytes before", at)
        sum.reset()
        summaryAt = start + 9 + length
        section = Section.Summary
      case footer: Record.Footer => checkFooter(footer, at)
      case _                     => addToSum(length)
    if section == Section.Header then section = Section.Data
    record match
      case chunk: Record.Chunk =>
        walk = Some(RecordWalk(Compression.decompress(chunk, limits, at), start, inChunk = true))
      case _ => ()
    val found = Parsed.Found(record, at, 9L + length)
    start += 9L + length
    headHas = 0
    content = Array.emptyByteArray
    phase = if opcode == Opcode.Footer then Phase.EndMagic else Phase.Head
    Option.when(known.takes(record, at))(found)

  private def addToSum(bytes: Int): Unit =
    sum.update(head, 0, 9)
    sum.update(content, 0, bytes)

  private def checkFooter(footer: Record.Footer, at: Place): Unit =
    val expected = if start == summaryAt then 0L else summaryAt
    if footer.summaryStart != expected then
      val came = java.lang.Long.toUnsignedString(footer.summaryStart)
      Refused.malformed(at, s"a footer that says the summary starts at $expected", came)
    addToSum(16)
    Checksum.hold(footer.summaryCrc, sum.getValue.toInt, "the summary", at)

  private def cutRecord(): Option[Parsed] =
    if !noMore then Some(Parsed.NeedsBytes)
    else
      val at    = Place(start)
      val error = McapError.CutOff(at, s"$length bytes of ${Opcode.name(opcode)}", has)
      fail(error): Unit
      if opcode == Opcode.Chunk then
        walk = RecordCodec
          .beginningOfChunk(content, has, at)
          .map: chunk =>
            RecordWalk(
              Compression.decompress(chunk, limits, at, cut = true),
              start,
              inChunk = true,
              cut = true
            )
      None

private object StreamParser:
  /** Greatest allocation for a record ahead of its bytes. */
  private val Ahead = 4 << 20

  private enum Phase:
    case Start, Head, Content, EndMagic, End

  private enum Section(val name: String):
    case Header  extends Section("header")
    case Data    extends Section("data section")
    case Summary extends Section("summary")

    def hold(opcode: Int, at: Place): Unit =
      val fits = this match
        case Header  => opcode == Opcode.Header
        case Data    => Opcode.isOfData(opcode)
        case Summary => Opcode.isOfSummary(opcode)
      if !fits then Refused.malformed(at, s"a record of the $name", s"a ${Opcode.name(opcode)} record")
