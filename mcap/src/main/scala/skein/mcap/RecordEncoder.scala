package skein.mcap

import java.util.zip.CRC32
import scala.collection.immutable.SeqMap

/** Records to bytes. */
private[mcap] object RecordEncoder:

  def append(record: Record, out: ByteBuilder): Unit = record match
    case chunk: Record.Chunk           => appendChunk(chunk, out)
    case attachment: Record.Attachment => appendAttachment(attachment, out)
    case other                         => out.record(other.opcode)(content(other, out))

  private def content(record: Record, out: ByteBuilder): Unit = record match
    case Record.Header(profile, library) =>
      out.string(profile)
      out.string(library)
    case Record.Footer(summaryStart, summaryOffsetStart, crc) =>
      out.u64(summaryStart)
      out.u64(summaryOffsetStart)
      out.u32(crc)
    case Record.Schema(id, name, encoding, data) =>
      out.u16(id)
      out.string(name)
      out.string(encoding)
      out.u32(data.size)
      out.raw(data)
    case Record.Channel(id, schemaId, topic, encoding, metadata) =>
      out.u16(id)
      out.u16(schemaId)
      out.string(topic)
      out.string(encoding)
      strings(metadata, out)
    case Record.Message(channelId, sequence, logTime, publishTime, data) =>
      out.u16(channelId)
      out.u32(sequence)
      out.u64(logTime)
      out.u64(publishTime)
      out.raw(data)
    case Record.MessageIndex(channelId, entries) =>
      out.u16(channelId)
      out.u32(entries.size)
      out.raw(entries)
    case Record.Metadata(name, metadata) =>
      out.string(name)
      strings(metadata, out)
    case Record.DataEnd(crc)           => out.u32(crc)
    case Record.Other(_, bytes)        => out.raw(bytes)
    case index: Record.ChunkIndex      => chunkIndex(index, out)
    case statistics: Record.Statistics => summed(statistics, out)
    case Record.AttachmentIndex(offset, length, logTime, createTime, dataSize, name, mediaType) =>
      out.u64(offset)
      out.u64(length)
      out.u64(logTime)
      out.u64(createTime)
      out.u64(dataSize)
      out.string(name)
      out.string(mediaType)
    case Record.MetadataIndex(offset, length, name) =>
      out.u64(offset)
      out.u64(length)
      out.string(name)
    case Record.SummaryOffset(opcode, start, length) =>
      out.u8(opcode)
      out.u64(start)
      out.u64(length)
    case chunk: Record.Chunk           => throw AssertionError(chunk)
    case attachment: Record.Attachment => throw AssertionError(attachment)

  private def chunkIndex(index: Record.ChunkIndex, out: ByteBuilder): Unit =
    out.u64(index.startTime)
    out.u64(index.endTime)
    out.u64(index.chunkStart)
    out.u64(index.chunkLength)
    numbers(index.messageIndexOffsets, out)
    out.u64(index.messageIndexLength)
    out.string(index.compression)
    out.u64(index.compressedSize)
    out.u64(index.uncompressedSize)

  private def summed(statistics: Record.Statistics, out: ByteBuilder): Unit =
    out.u64(statistics.messageCount)
    out.u16(statistics.schemaCount)
    out.u32(statistics.channelCount)
    out.u32(statistics.attachmentCount)
    out.u32(statistics.metadataCount)
    out.u32(statistics.chunkCount)
    out.u64(statistics.startTime)
    out.u64(statistics.endTime)
    numbers(statistics.channelMessageCounts, out)

  private def appendChunk(chunk: Record.Chunk, out: ByteBuilder): Unit =
    chunkHead(chunk, out)
    out.raw(chunk.records)

  /** A chunk up to its records, which then follow as they are. */
  def chunkHead(chunk: Record.Chunk, out: ByteBuilder): Unit =
    val at = out.size
    out.record(Opcode.Chunk):
      out.u64(chunk.startTime)
      out.u64(chunk.endTime)
      out.u64(chunk.uncompressedSize)
      out.u32(chunk.uncompressedCrc)
      out.string(chunk.compression)
      out.u64(chunk.records.size)
    out.patchU64(at + 1, out.size - at - 9L + chunk.records.size)

  private def appendAttachment(attachment: Record.Attachment, out: ByteBuilder): Unit =
    out.record(Opcode.Attachment):
      val at = out.size
      out.u64(attachment.logTime)
      out.u64(attachment.createTime)
      out.string(attachment.name)
      out.string(attachment.mediaType)
      out.u64(attachment.data.size)
      out.raw(attachment.data)
      val crc = CRC32()
      crc.update(out.array, at, out.size - at)
      out.u32(crc.getValue.toInt)

  private def strings(map: SeqMap[String, String], out: ByteBuilder): Unit =
    out.counted:
      map.foreach: (key, value) =>
        out.string(key)
        out.string(value)

  private def numbers(map: SeqMap[Int, Long], out: ByteBuilder): Unit =
    out.counted:
      map.foreach: (key, value) =>
        out.u16(key)
        out.u64(value)
