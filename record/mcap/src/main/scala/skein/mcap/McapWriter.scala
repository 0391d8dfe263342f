package skein.mcap

import java.util.zip.CRC32
import scala.collection.immutable.{SeqMap, VectorMap}
import scala.collection.mutable

/** Writes a file, record by record, into a sink; does no I/O of its own. Every part carries its CRC.
  * Everything written is in the sink after `flush` or `finish`; if the process ends before, the file can
  * still be read up to the last chunk. Memory: one chunk, compressed and not, and 16 bytes for each message
  * in it; for the summary, 100 bytes for each chunk, attachment and metadata record.
  *
  * For one thread at a time.
  */
final class McapWriter(sink: ByteSink, options: WriterOptions = WriterOptions()):
  private val out           = ByteBuilder(McapWriter.Gathered)
  private val sum           = CRC32()
  private var offset        = 0L
  private var finished      = false
  private val chunk         = ByteBuilder(if options.chunked then options.chunkBytes else 0)
  private val chunkTimes    = Times()
  private val times         = Times()
  private val schemas       = mutable.ArrayBuffer.empty[Record.Schema]
  private val channels      = mutable.ArrayBuffer.empty[ChannelLog]
  private val chunks        = mutable.ArrayBuffer.empty[Record.ChunkIndex]
  private val attachments   = mutable.ArrayBuffer.empty[Record.AttachmentIndex]
  private val metadatas     = mutable.ArrayBuffer.empty[Record.MetadataIndex]
  private var chunkCount    = 0
  private var attachedCount = 0
  private var metadataCount = 0

  out.raw(Magic.bytes)
  RecordCodec.append(Record.Header(options.profile, options.library), out)

  /** Defines a schema; returns its identifier.
    *
    * @param encoding such as `protobuf` or `jsonschema`
    */
  def schema(name: String, encoding: String, data: Bytes): Int =
    open()
    require(schemas.size < McapWriter.MostIds, "more than 65,535 schemas")
    val schema = Record.Schema(schemas.size + 1, name, encoding, data)
    schemas += schema
    put(schema)
    schema.id

  /** Defines a channel; returns its identifier.
    *
    * @param schemaId schema of the channel's messages; 0 for none
    */
  def channel(
      topic: String,
      messageEncoding: String,
      schemaId: Int = 0,
      metadata: SeqMap[String, String] = VectorMap.empty
  ): Int =
    open()
    require(channels.size < McapWriter.MostIds, "more than 65,535 channels")
    require(schemaId >= 0 && schemaId <= schemas.size, s"no schema $schemaId has been named")
    val channel = Record.Channel(channels.size + 1, schemaId, topic, messageEncoding, metadata)
    channels += ChannelLog(channel)
    put(channel)
    channel.id

  /** Writes a message of a defined channel.
    *
    * @param logTime when it was recorded, ns
    * @param publishTime when it was sent, ns; the log time if unknown
    */
  def message(channelId: Int, sequence: Int, logTime: Long, publishTime: Long, data: Bytes): Unit =
    open()
    require(channelId > 0 && channelId <= channels.size, s"no channel $channelId has been named")
    val log    = channels(channelId - 1)
    val target = if options.chunked then chunk else out
    if options.chunked then
      chunkTimes.add(logTime)
      log.add(logTime, chunk.size)
    times.add(logTime)
    log.count += 1
    target.u8(Opcode.Message)
    target.u64(22L + data.size)
    target.u16(channelId)
    target.u32(sequence)
    target.u64(logTime)
    target.u64(publishTime)
    target.raw(data.array, data.from, data.from + data.size)
    room()

  /** @param createTime ns; 0 if unknown */
  def attachment(logTime: Long, createTime: Long, name: String, mediaType: String, data: Bytes): Unit =
    open()
    val start = offset + out.size
    RecordCodec.append(Record.Attachment(logTime, createTime, name, mediaType, data, 0), out)
    val length = offset + out.size - start
    attachedCount += 1
    if options.attachmentIndex then
      attachments += Record.AttachmentIndex(start, length, logTime, createTime, data.size, name, mediaType)
    room()

  def metadata(name: String, entries: SeqMap[String, String]): Unit =
    open()
    val start = offset + out.size
    RecordCodec.append(Record.Metadata(name, entries), out)
    metadataCount += 1
    if options.metadataIndex then
      metadatas += Record.MetadataIndex(start, offset + out.size - start, name)
    room()

  /** Ends the chunk, and passes everything to the sink. */
  def flush(): Unit =
    open()
    endChunk()
    drain()

  /** Writes the summary and the end. Nothing can be written afterwards. */
  def finish(): Unit =
    flush()
    finished = true
    RecordCodec.append(Record.DataEnd(sum.getValue.toInt), out)
    drain()
    sum.reset()
    val start   = offset
    val groups  = summary()
    val empty   = out.size == 0
    val offsets = offset + out.size
    if options.summaryOffsets then groups.foreach(RecordCodec.append(_, out))
    val footer = Record.Footer(
      if empty then 0 else start,
      if options.summaryOffsets && groups.nonEmpty then offsets else 0,
      0
    )
    val at = out.size
    RecordCodec.append(footer, out)
    // The CRC covers the footer up to itself.
    sum.update(out.array, 0, at + 9 + 16)
    out.patchU32(at + 9 + 16, sum.getValue.toInt)
    out.raw(Magic.bytes)
    drain()

  private def open(): Unit = require(!finished, "written after it was finished")

  private def put(record: Record): Unit =
    RecordCodec.append(record, if options.chunked then chunk else out)
    room()

  private def room(): Unit =
    if chunk.size >= options.chunkBytes then endChunk()
    if out.size >= McapWriter.Gathered then drain()

  private def drain(): Unit =
    pass(out.array, 0, out.size)
    out.clear()

  private def pass(array: Array[Byte], from: Int, until: Int): Unit =
    sum.update(array, from, until - from)
    offset += until - from
    sink.write(array, from, until)

  private def endChunk(): Unit =
    if chunk.size > 0 then
      val crc    = Checksum.of(chunk.array, 0, chunk.size)
      val packed = options.compression.compress(chunk.array, 0, chunk.size)
      val record =
        Record.Chunk(chunkTimes.start, chunkTimes.end, chunk.size, crc, options.compression.name, packed)
      drain()
      val start = offset
      RecordCodec.chunkHead(record, out)
      drain()
      pass(packed.array, packed.from, packed.from + packed.size)
      val length  = offset - start
      val indexes = messageIndexes()
      chunkCount += 1
      if options.chunkIndex then
        chunks += Record.ChunkIndex(
          record.startTime,
          record.endTime,
          start,
          length,
          indexes,
          offset + out.size - start - length,
          record.compression,
          packed.size,
          chunk.size
        )
      chunk.clear()
      chunkTimes.clear()

  private def messageIndexes(): VectorMap[Int, Long] =
    val offsets = VectorMap.newBuilder[Int, Long]
    channels.foreach: log =>
      if log.entries.size > 0 then
        if options.messageIndex then
          offsets += log.channel.id -> (offset + out.size)
          RecordCodec.append(
            Record.MessageIndex(log.channel.id, Bytes.of(log.entries.array, 0, log.entries.size)),
            out
          )
        log.entries.clear()
    offsets.result()

  private def summary(): Vector[Record.SummaryOffset] =
    val groups = Vector(
      if options.repeatSchemas then schemas.toVector else Vector.empty,
      if options.repeatChannels then channels.map(_.channel).toVector else Vector.empty,
      if options.statistics then Vector(statistics) else Vector.empty,
      metadatas.toVector,
      attachments.toVector,
      chunks.toVector
    )
    groups
      .filter(_.nonEmpty)
      .map: group =>
        val start = out.size
        group.foreach(RecordCodec.append(_, out))
        Record.SummaryOffset(group.head.opcode, offset + start, out.size - start)

  private def statistics = Record.Statistics(
    channels.map(_.count).sum,
    schemas.size,
    channels.size,
    attachedCount,
    metadataCount,
    chunkCount,
    times.start,
    times.end,
    channels.filter(_.count > 0).map(log => log.channel.id -> log.count).to(VectorMap)
  )

  private final class ChannelLog(val channel: Record.Channel):
    var count: Long = 0
    val entries     = ByteBuilder(64)

    def add(time: Long, offset: Long): Unit =
      entries.u64(time)
      entries.u64(offset)

private object McapWriter:
  /** Bytes gathered before they are passed to the sink. */
  private val Gathered = 64 << 10

  private val MostIds = 0xffff
