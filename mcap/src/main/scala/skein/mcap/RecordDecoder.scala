package skein.mcap

/** Bytes to records. */
private[mcap] object RecordDecoder:

  /** The record whose content is `array[from, until)`; it keeps a view of the array. `place` is where the record starts. */
  def decode(opcode: Int, array: Array[Byte], from: Int, until: Int, place: Place): Record =
    val fields = Fields(array, from, until, Opcode.name(opcode), place)
    opcode match
      case Opcode.Message         => message(fields)
      case Opcode.Header          => Record.Header(fields.string("profile"), fields.string("library"))
      case Opcode.Footer          => footer(fields)
      case Opcode.Schema          => schema(fields)
      case Opcode.Channel         => channel(fields)
      case Opcode.Chunk           => chunk(fields)
      case Opcode.MessageIndex    => messageIndex(fields, place)
      case Opcode.ChunkIndex      => chunkIndex(fields)
      case Opcode.Attachment      => attachment(fields, place)
      case Opcode.AttachmentIndex => attachmentIndex(fields)
      case Opcode.Statistics      => statistics(fields)
      case Opcode.Metadata        => Record.Metadata(fields.string("name"), fields.strings("metadata"))
      case Opcode.MetadataIndex   =>
        Record.MetadataIndex(fields.u64("offset"), fields.u64("length"), fields.string("name"))
      case Opcode.SummaryOffset =>
        Record.SummaryOffset(fields.u8("group_opcode"), fields.u64("group_start"), fields.u64("group_length"))
      case Opcode.DataEnd => Record.DataEnd(fields.u32("data_section_crc"))
      case 0              => Refused.malformed(place, "a record", "0x00, which is no kind of record")
      case other          => Record.Other(other, fields.rest())

  private def message(fields: Fields) =
    Record.Message(
      fields.u16("channel_id"),
      fields.u32("sequence"),
      fields.u64("log_time"),
      fields.u64("publish_time"),
      fields.rest()
    )

  private def footer(fields: Fields) =
    val footer =
      Record.Footer(
        fields.u64("summary_start"),
        fields.u64("summary_offset_start"),
        fields.u32("summary_crc")
      )
    fields.expectEnd()
    footer

  private def schema(fields: Fields) =
    Record.Schema(fields.u16("id"), fields.string("name"), fields.string("encoding"), fields.bytes32("data"))

  private def channel(fields: Fields) =
    Record.Channel(
      fields.u16("id"),
      fields.u16("schema_id"),
      fields.string("topic"),
      fields.string("message_encoding"),
      fields.strings("metadata")
    )

  private def chunk(fields: Fields) =
    Record.Chunk(
      fields.u64("message_start_time"),
      fields.u64("message_end_time"),
      fields.u64("uncompressed_size"),
      fields.u32("uncompressed_crc"),
      fields.string("compression"),
      fields.bytes64("records")
    )

  /** Of a chunk that is cut off: what there is of its records, once all fields before are there. */
  def beginningOfChunk(array: Array[Byte], until: Int, place: Place): Option[Record.Chunk] =
    val fields = Fields(array, 0, until, Opcode.name(Opcode.Chunk), place)
    Refused
      .either:
        val empty = Record.Chunk(
          fields.u64("message_start_time"),
          fields.u64("message_end_time"),
          fields.u64("uncompressed_size"),
          fields.u32("uncompressed_crc"),
          fields.string("compression"),
          Bytes.empty
        )
        val _ = fields.u64("records")
        empty.copy(records = fields.rest())
      .toOption

  private def messageIndex(fields: Fields, place: Place) =
    val index = Record.MessageIndex(fields.u16("channel_id"), fields.bytes32("records"))
    if index.entries.size % 16 != 0 then
      Refused.malformed(
        place,
        "entries of 16 bytes in its Message Index record",
        s"${index.entries.size} bytes"
      )
    index

  private def chunkIndex(fields: Fields) =
    Record.ChunkIndex(
      fields.u64("message_start_time"),
      fields.u64("message_end_time"),
      fields.u64("chunk_start_offset"),
      fields.u64("chunk_length"),
      fields.numbers("message_index_offsets"),
      fields.u64("message_index_length"),
      fields.string("compression"),
      fields.u64("compressed_size"),
      fields.u64("uncompressed_size")
    )

  private def attachment(fields: Fields, place: Place) =
    val fieldsOnly = Record.Attachment(
      fields.u64("log_time"),
      fields.u64("create_time"),
      fields.string("name"),
      fields.string("media_type"),
      fields.bytes64("data"),
      0
    )
    val computed = fields.crc
    val written  = fields.u32("crc")
    Checksum.hold(written, computed, s"the attachment \"${fieldsOnly.name}\"", place)
    fieldsOnly.copy(crc = written)

  private def attachmentIndex(fields: Fields) =
    Record.AttachmentIndex(
      fields.u64("offset"),
      fields.u64("length"),
      fields.u64("log_time"),
      fields.u64("create_time"),
      fields.u64("data_size"),
      fields.string("name"),
      fields.string("media_type")
    )

  private def statistics(fields: Fields) =
    Record.Statistics(
      fields.u64("message_count"),
      fields.u16("schema_count"),
      fields.u32("channel_count"),
      fields.u32("attachment_count"),
      fields.u32("metadata_count"),
      fields.u32("chunk_count"),
      fields.u64("message_start_time"),
      fields.u64("message_end_time"),
      fields.numbers("channel_message_counts")
    )
