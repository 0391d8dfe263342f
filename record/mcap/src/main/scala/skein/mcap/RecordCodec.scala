package skein.mcap

/** Encodes records as bytes, and decodes them. */
private[mcap] object RecordCodec:

  def append(record: Record, out: ByteBuilder): Unit = record match
    case attachment: Record.Attachment => appendAttachment(attachment, out)
    case chunk: Record.Chunk           =>
      chunkHead(chunk, out)
      out.raw(chunk.records)
    case other => out.record(other.opcode)(content(other, out))

  private def content(record: Record, out: ByteBuilder): Unit = record match
    case Record.Message(channelId, sequence, logTime, publishTime, data) =>
      out.u16(channelId)
      out.u32(sequence)
      out.u64(logTime)
      out.u64(publishTime)
      out.raw(data)
    case Record.Other(_, bytes) => out.raw(bytes)
    case other                  => RecordLayout.plain(other.opcode).write(other, out)

  /** Writes a chunk up to its records, which then follow unchanged. */
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
      out.u32(Checksum.of(out.array, at, out.size))

  /** Decodes the record whose content is `array[from, until)`; it keeps a view of the array. `place` is the
    * record's start.
    */
  def decode(opcode: Int, array: Array[Byte], from: Int, until: Int, place: Place): Record =
    val fields = Fields(array, from, until, Opcode.name(opcode), place)
    opcode match
      case Opcode.Message    => message(fields)
      case Opcode.Chunk      => chunk(fields, whole = true)
      case Opcode.Attachment => attachment(fields, place)
      case 0                 => Refused.malformed(place, "a record", "0x00, which is no kind of record")
      case other             =>
        RecordLayout.plain.get(other) match
          case None         => Record.Other(other, fields.rest())
          case Some(layout) =>
            val record = layout.read(fields)
            hold(record, fields, place)
            record

  /** Checks further constraints of a kind of record. */
  private def hold(record: Record, fields: Fields, place: Place): Unit = record match
    case _: Record.Footer => fields.expectEnd()
    case Record.MessageIndex(_, entries) if entries.size % 16 != 0 =>
      Refused.malformed(place, "entries of 16 bytes in its Message Index record", s"${entries.size} bytes")
    case _ => ()

  private def message(fields: Fields) =
    Record.Message(
      fields.u16("channel_id"),
      fields.u32("sequence"),
      fields.u64("log_time"),
      fields.u64("publish_time"),
      fields.rest()
    )

  /** The complete records of a truncated chunk, if all fields before them are complete. */
  def beginningOfChunk(array: Array[Byte], until: Int, place: Place): Option[Record.Chunk] =
    val fields = Fields(array, 0, until, Opcode.name(Opcode.Chunk), place)
    Refused.either(chunk(fields, whole = false)).toOption

  private def chunk(fields: Fields, whole: Boolean) =
    def beginning() =
      val _ = fields.u64("records")
      fields.rest()
    Record.Chunk(
      fields.u64("message_start_time"),
      fields.u64("message_end_time"),
      fields.u64("uncompressed_size"),
      fields.u32("uncompressed_crc"),
      fields.string("compression"),
      if whole then fields.bytes64("records") else beginning()
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
