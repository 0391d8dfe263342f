package skein.mcap

/** Written files are read back unchanged. */
class RoundTripLaws extends munit.FunSuite:

  test("a stream returns every message, attachment and metadata record as it was written"):
    for seed <- 1L to 400 do
      val file = RandomFile.draw(seed)
      val read = Parsing.all(file.bytes, piece = 1 + (seed * 37 % 500).toInt)
      assertEquals(read.end, Parsed.Ended, file.show)
      assertEquals(read.messages, file.messages, file.show)
      assertEquals(attachments(read.records), file.attachments, file.show)
      assertEquals(read.records.collect { case record: Record.Metadata => record }, file.metadata, file.show)

  test("in a file with all indexes, every index points to its record"):
    for seed <- 1L to 200 do
      val file  = RandomFile.draw(seed, options = RandomFile.indexed)
      val found = Parsing.all(file.bytes).found
      val at    = found.collect { case one if one.at.inChunk < 0 => one.at.offset -> one }.toMap
      val kinds = found.map(_.record).collect:
        case index: Record.ChunkIndex =>
          assertEquals(at(index.chunkStart).length, index.chunkLength, file.show)
          index.messageIndexOffsets.values.foreach: offset =>
            assertEquals(at(offset).record.opcode, Opcode.MessageIndex, file.show)
          at(index.chunkStart).record.opcode
        case index: Record.AttachmentIndex =>
          assertEquals(at(index.offset).length, index.length, file.show)
          at(index.offset).record.opcode
        case index: Record.MetadataIndex =>
          assertEquals(at(index.offset).length, index.length, file.show)
          at(index.offset).record.opcode
      val indexed = Set(Opcode.Chunk, Opcode.Attachment, Opcode.Metadata)
      assertEquals(kinds.sorted, found.map(_.record.opcode).filter(indexed).sorted, file.show)

  test("the statistics of a file count its content"):
    for seed <- 1L to 200 do
      val file = RandomFile.draw(seed, options = RandomFile.indexed)
      val read = Parsing.all(file.bytes)
      read.records.collect { case counts: Record.Statistics => counts }.foreach: counts =>
        assertEquals(counts.messageCount, file.messages.size.toLong, file.show)
        assertEquals(counts.schemaCount, file.schemas.size, file.show)
        assertEquals(counts.channelCount, file.channels.size, file.show)
        assertEquals(counts.attachmentCount, file.attachments.size, file.show)
        assertEquals(counts.metadataCount, file.metadata.size, file.show)
        assertEquals(counts.chunkCount, read.records.count(_.opcode == Opcode.Chunk), file.show)
        val times = file.byTime.map(_.logTime)
        assertEquals(
          (counts.startTime, counts.endTime),
          (times.headOption.getOrElse(0L), times.lastOption.getOrElse(0L)),
          file.show
        )

  private def attachments(records: Vector[Record]) = records.collect:
    case record: Record.Attachment => record.copy(crc = 0)
