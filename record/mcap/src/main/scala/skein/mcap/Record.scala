package skein.mcap

import scala.collection.immutable.SeqMap

/** A record of an MCAP file, as the specification defines it (https://mcap.dev/spec). Times are nanoseconds
  * since an epoch that reader and writer agree on, unsigned; so are sizes and offsets, which count bytes from
  * the start of the file. Identifiers are unsigned 16 bit, a sequence number unsigned 32 bit. A CRC of 0
  * means that there is none.
  */
sealed abstract class Record(val opcode: Int) extends Product

object Record:
  final case class Header(profile: String, library: String) extends Record(Opcode.Header)

  /** @param summaryStart 0 without a summary
    * @param summaryOffsetStart 0 without summary offsets
    */
  final case class Footer(summaryStart: Long, summaryOffsetStart: Long, summaryCrc: Int)
      extends Record(Opcode.Footer)

  /** @param encoding language of the schema itself, such as `protobuf` or `jsonschema`; empty without one */
  final case class Schema(id: Int, name: String, encoding: String, data: Bytes) extends Record(Opcode.Schema)

  /** @param schemaId schema of the channel's messages; 0 without one */
  final case class Channel(
      id: Int,
      schemaId: Int,
      topic: String,
      messageEncoding: String,
      metadata: SeqMap[String, String]
  ) extends Record(Opcode.Channel)

  /** @param logTime when it was recorded
    * @param publishTime when it was sent; the log time if unknown
    */
  final case class Message(channelId: Int, sequence: Int, logTime: Long, publishTime: Long, data: Bytes)
      extends Record(Opcode.Message)

  /** @param startTime earliest log time of its messages; 0 without messages
    * @param endTime latest log time of its messages; 0 without messages
    * @param records schemas, channels and messages, compressed
    */
  final case class Chunk(
      startTime: Long,
      endTime: Long,
      uncompressedSize: Long,
      uncompressedCrc: Int,
      compression: String,
      records: Bytes
  ) extends Record(Opcode.Chunk)

  /** @param entries one entry of 16 bytes for each message of the channel in the preceding chunk: its log
    *   time, and its offset in the chunk's records
    */
  final case class MessageIndex(channelId: Int, entries: Bytes) extends Record(Opcode.MessageIndex)

  /** @param messageIndexOffsets offsets of the message indices by channel; empty without any */
  final case class ChunkIndex(
      startTime: Long,
      endTime: Long,
      chunkStart: Long,
      chunkLength: Long,
      messageIndexOffsets: SeqMap[Int, Long],
      messageIndexLength: Long,
      compression: String,
      compressedSize: Long,
      uncompressedSize: Long
  ) extends Record(Opcode.ChunkIndex)

  /** @param crc CRC of all fields before it; computed by the writer */
  final case class Attachment(
      logTime: Long,
      createTime: Long,
      name: String,
      mediaType: String,
      data: Bytes,
      crc: Int
  ) extends Record(Opcode.Attachment)

  final case class AttachmentIndex(
      offset: Long,
      length: Long,
      logTime: Long,
      createTime: Long,
      dataSize: Long,
      name: String,
      mediaType: String
  ) extends Record(Opcode.AttachmentIndex)

  /** @param channelMessageCounts number of messages by channel; empty if not counted */
  final case class Statistics(
      messageCount: Long,
      schemaCount: Int,
      channelCount: Int,
      attachmentCount: Int,
      metadataCount: Int,
      chunkCount: Int,
      startTime: Long,
      endTime: Long,
      channelMessageCounts: SeqMap[Int, Long]
  ) extends Record(Opcode.Statistics)

  final case class Metadata(name: String, metadata: SeqMap[String, String]) extends Record(Opcode.Metadata)

  final case class MetadataIndex(offset: Long, length: Long, name: String)
      extends Record(Opcode.MetadataIndex)

  final case class SummaryOffset(groupOpcode: Int, groupStart: Long, groupLength: Long)
      extends Record(Opcode.SummaryOffset)

  /** @param dataCrc CRC of all bytes of the file before this record */
  final case class DataEnd(dataCrc: Int) extends Record(Opcode.DataEnd)

  /** A record of a kind that the specification does not define. */
  final case class Other(kind: Int, content: Bytes) extends Record(kind)
