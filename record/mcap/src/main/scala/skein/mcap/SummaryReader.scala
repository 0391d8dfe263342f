package skein.mcap

import scala.annotation.tailrec
import scala.collection.mutable

/** Finds out what a file holds: from its summary, or by reading it through. */
private[mcap] object SummaryReader:
  private val FooterLength = 9 + 20

  /** The summary; by reading through the file where it is cut off, or where its summary does not lead to all
    * messages.
    */
  def read(source: ByteSource, limits: McapLimits): Summary =
    val header = this.header(source, limits)
    val tail   = FooterLength + Magic.bytes.size
    val whole  = source.size >= Magic.bytes.size + tail &&
      source.read(source.size - Magic.bytes.size, Magic.bytes.size) == Magic.bytes
    if !whole then SummaryScan.read(source, limits)
    else
      val at     = source.size - tail
      val footer = RecordWalk(source.read(at, FooterLength), at, inChunk = false)
      if !footer.step() || footer.opcode != Opcode.Footer then
        Refused.malformed(Place(at), "the Footer record", s"a ${Opcode.name(footer.opcode)} record")
      else
        footer.record match
          case ends: Record.Footer if ends.summaryStart == 0 => SummaryScan.read(source, limits)
          case ends: Record.Footer                           =>
            fromSection(header, ends, at, source, limits).getOrElse(SummaryScan.read(source, limits))
          case other => Refused.malformed(Place(at), "the Footer record", s"$other")

  private def header(source: ByteSource, limits: McapLimits): Record.Header =
    val begins = source.read(0, source.size.min(Magic.bytes.size).toInt)
    if begins.size == 0 || begins != Magic.bytes.slice(0, begins.size) then
      throw Refused(McapError.NotMcap(begins))
    FromBeginning(source, limits, 4096).next() match
      case Parsed.Found(found: Record.Header, _, _) => found
      case Parsed.Failed(error)                     => throw Refused(error)
      case other                                    => throw AssertionError(other)

  private def fromSection(
      header: Record.Header,
      footer: Record.Footer,
      footerAt: Long,
      source: ByteSource,
      limits: McapLimits
  ): Option[Summary] =
    val start = footer.summaryStart
    if java.lang.Long.compareUnsigned(start, footerAt) > 0 then
      Refused.malformed(
        Place(footerAt),
        s"a summary that starts before byte $footerAt",
        s"one at ${java.lang.Long.toUnsignedString(start)}"
      )
    limits.hold(footerAt - start, limits.summaryBytes, "the summary", Place(start))
    val section = source.read(start, (footerAt - start).toInt + FooterLength)
    val crc     = Checksum.of(section.array, section.from, section.from + section.size - 4)
    Checksum.hold(footer.summaryCrc, crc, "the summary", Place(start))
    val schemas     = mutable.Map.empty[Int, Record.Schema]
    val channels    = mutable.Map.empty[Int, Record.Channel]
    var statistics  = Option.empty[Record.Statistics]
    val chunks      = Vector.newBuilder[Record.ChunkIndex]
    val attachments = Vector.newBuilder[Record.AttachmentIndex]
    val metadata    = Vector.newBuilder[Record.MetadataIndex]
    val walk        = RecordWalk(section.slice(0, section.size - FooterLength), start, inChunk = false)
    while walk.step() do
      val at = walk.place
      if !Opcode.isOfSummary(walk.opcode) then
        Refused.malformed(at, "a record of the summary", s"a ${Opcode.name(walk.opcode)} record")
      walk.record match
        case schema: Record.Schema    => schemas(schema.id) = schema
        case channel: Record.Channel  => channels(channel.id) = channel
        case index: Record.ChunkIndex =>
          within(index.chunkStart, index.chunkLength, start, at)
          chunks += index
        case index: Record.AttachmentIndex =>
          within(index.offset, index.length, start, at)
          attachments += index
        case index: Record.MetadataIndex =>
          within(index.offset, index.length, start, at)
          metadata += index
        case counts: Record.Statistics => statistics = Some(counts)
        case _                         => ()
    val found = Summary(
      header,
      schemas.toMap,
      channels.toMap,
      statistics,
      attachments.result(),
      metadata.result(),
      chunks.result().sortBy(_.chunkStart).map(stretch),
      rebuilt = false,
      cut = None
    )
    Option.when(leadsToAll(found))(found)

  private def stretch(index: Record.ChunkIndex) = Stretch(
    index.chunkStart,
    index.chunkLength,
    index.startTime,
    index.endTime,
    Option.when(index.messageIndexOffsets.nonEmpty)(index.messageIndexOffsets.keySet.toSet),
    Stretch.Kind.Chunk
  )

  private def within(offset: Long, length: Long, limit: Long, at: Place): Unit =
    if offset < 0 || length < 9 || offset > limit || length > limit - offset then
      val came = s"$length bytes at ${java.lang.Long.toUnsignedString(offset)}"
      Refused.malformed(at, s"an index of a record before byte $limit", came)

  /** Whether every message can be found by it, as far as it says itself. */
  private def leadsToAll(summary: Summary): Boolean =
    val named = summary.stretches.forall(_.channels.forall(_.subsetOf(summary.channels.keySet))) &&
      summary.channels.values.forall(channel =>
        channel.schemaId == 0 || summary.schemas.contains(channel.schemaId)
      )
    named && (summary.statistics match
      case None         => summary.stretches.nonEmpty && summary.stretches.forall(_.channels.isDefined)
      case Some(counts) =>
        summary.stretches.size == counts.chunkCount &&
        (counts.messageCount == 0 || summary.stretches.nonEmpty) &&
        summary.channels.size == counts.channelCount &&
        summary.attachments.size == counts.attachmentCount &&
        summary.metadata.size == counts.metadataCount)

/** A source's records, from its first byte on.
  *
  * @param piece bytes that are read at a time
  */
private final class FromBeginning(source: ByteSource, limits: McapLimits, piece: Int):
  private val parser = StreamParser(limits)
  private var at     = 0L

  @tailrec def next(): Parsed = parser.next() match
    case Parsed.NeedsBytes =>
      if at == source.size then parser.end()
      else
        val read = source.read(at, (source.size - at).min(piece).toInt)
        parser.offer(read.array, read.from, read.from + read.size)
        at += read.size
      next()
    case other => other

/** Reads a file through for what its summary would say. */
private object SummaryScan:
  private val Piece = 1 << 20

  /** Messages outside of chunks are gathered in stretches of about so many bytes. */
  private val LooseBytes = 1 << 20

  def read(source: ByteSource, limits: McapLimits): Summary =
    val records                   = FromBeginning(source, limits, Piece)
    val scan                      = Scan()
    @tailrec def whole(): Summary = records.next() match
      case found: Parsed.Found =>
        scan.take(found)
        whole()
      case Parsed.Failed(cut: McapError.CutOff) => scan.result(Some(cut), source.size)
      case Parsed.Failed(error)                 => throw Refused(error)
      case _                                    => scan.result(None, source.size)
    whole()

  private final class Scan:
    private var header       = Option.empty[Record.Header]
    private val schemas      = mutable.Map.empty[Int, Record.Schema]
    private val channels     = mutable.Map.empty[Int, Record.Channel]
    private val attachments  = Vector.newBuilder[Record.AttachmentIndex]
    private val metadata     = Vector.newBuilder[Record.MetadataIndex]
    private val stretches    = Vector.newBuilder[Stretch]
    private val counts       = mutable.LongMap.empty[Long].withDefaultValue(0L)
    private val times        = Times()
    private val openTimes    = Times()
    private val openChannels = mutable.Set.empty[Int]
    private var openKind     = Stretch.Kind.Loose
    private var openAt       = -1L
    private var openUntil    = 0L
    private var chunkCount   = 0
    private var attached     = 0
    private var described    = 0

    def take(found: Parsed.Found): Unit =
      found.record match
        case record: Record.Header  => header = Some(record)
        case record: Record.Schema  => schemas(record.id) = record
        case record: Record.Channel => channels(record.id) = record
        case record: Record.Message => message(record, found)
        case _: Record.Chunk        =>
          close()
          chunkCount += 1
          openAt = found.at.offset
          openUntil = openAt + found.length
          openKind = Stretch.Kind.Chunk
        case record: Record.Attachment =>
          if openKind == Stretch.Kind.Loose then close()
          attached += 1
          attachments += Record.AttachmentIndex(
            found.at.offset,
            found.length,
            record.logTime,
            record.createTime,
            record.data.size,
            record.name,
            record.mediaType
          )
        case record: Record.Metadata =>
          if openKind == Stretch.Kind.Loose then close()
          described += 1
          metadata += Record.MetadataIndex(found.at.offset, found.length, record.name)
        case _ => ()

    private def message(message: Record.Message, found: Parsed.Found): Unit =
      val at    = found.at
      val loose = at.inChunk < 0
      val full  = openUntil - openAt >= LooseBytes
      if openAt < 0 || loose && (openKind != Stretch.Kind.Loose || full) || !loose && at.offset != openAt then
        close()
        openAt = at.offset
        // Of a chunk that is cut off, the records come without the chunk.
        openKind = if loose then Stretch.Kind.Loose else Stretch.Kind.CutChunk
      if loose then openUntil = at.offset + found.length
      openTimes.add(message.logTime)
      openChannels += message.channelId
      times.add(message.logTime)
      counts(message.channelId) += 1

    private def close(): Unit =
      if openAt >= 0 && !openTimes.isEmpty then
        stretches += Stretch(
          openAt,
          openUntil - openAt,
          openTimes.start,
          openTimes.end,
          Some(openChannels.toSet),
          openKind
        )
      openAt = -1
      openTimes.clear()
      openChannels.clear()

    def result(cut: Option[McapError], size: Long): Summary =
      if openKind == Stretch.Kind.CutChunk then openUntil = size
      close()
      val statistics = Record.Statistics(
        counts.values.sum,
        schemas.size,
        channels.size,
        attached,
        described,
        chunkCount,
        times.start,
        times.end,
        counts.toVector.sortBy(
          _._1
        ).map((id, count) => id.toInt -> count).to(scala.collection.immutable.VectorMap)
      )
      Summary(
        header.getOrElse(Record.Header("", "")),
        schemas.toMap,
        channels.toMap,
        Some(statistics),
        attachments.result(),
        metadata.result(),
        stretches.result(),
        rebuilt = true,
        cut
      )
