package skein.mcap

class McapLimitsSuite extends munit.FunSuite:
  private val begin =
    val out = ByteBuilder(64)
    out.raw(Magic.bytes)
    RecordCodec.append(Record.Header("", ""), out)
    Bytes.of(out.array.take(out.size))

  private def after(records: ByteBuilder => Unit): Bytes =
    val out = ByteBuilder(64)
    out.raw(begin)
    records(out)
    Bytes.of(out.array.take(out.size))

  private def errorOf(file: Bytes, limits: McapLimits = McapLimits()) =
    Parsing.all(file, limits = limits).end match
      case Parsed.Failed(error) => error.message
      case other                => s"$other"

  test("a record whose stated size exceeds the limit is refused before memory is allocated"):
    val file = after: out =>
      out.u8(Opcode.Attachment)
      out.u64(-2L)
    assertEquals(
      errorOf(file),
      "byte 25: a Attachment record claims 18446744073709551614 bytes, expected at most 268435456"
    )

  test("a stated size within the limit allocates no memory ahead of the bytes"):
    val runtime = Runtime.getRuntime
    val file    = after: out =>
      out.u8(Opcode.Attachment)
      out.u64(Int.MaxValue - 100)
    val limits = McapLimits(recordBytes = Int.MaxValue - 100)
    // More such parsers than the heap could hold if each allocated the stated size.
    val parsers = Vector.fill((runtime.maxMemory >> 31).toInt + 8): () =>
      val parser = StreamParser(limits)
      parser.offer(file.toArray)
      while parser.next() != Parsed.NeedsBytes do ()
      parser
    assertEquals(parsers.map(_()).map(_.next()).toSet, Set(Parsed.NeedsBytes))

  test("a chunk whose stated size exceeds the limit is refused"):
    val file = after(RecordCodec.append(Record.Chunk(0, 0, 1L << 40, 0, "zstd", Bytes.empty), _))
    assertEquals(
      errorOf(file),
      "byte 25: a chunk, uncompressed, claims 1099511627776 bytes, expected at most 268435456"
    )

  test("errors state what was expected, what was found, and where"):
    assertEquals(
      errorOf(Bytes.utf8("SQLite format 3")),
      "byte 0: expected an MCAP file of version 0, which begins with 89 4d 43 41 50 30 0d 0a, " +
        "got 53 51 4c 69 74 65 20 66"
    )
    assertEquals(
      errorOf(after(RecordCodec.append(Record.Message(7, 0, 0, 0, Bytes.empty), _))),
      "byte 25: expected a message of a channel named before, got one of channel 7"
    )
    assertEquals(
      errorOf(after(RecordCodec.append(Record.Chunk(0, 0, 0, 0, "bz2", Bytes.empty), _))),
      "byte 25: expected a chunk compressed by zstd, by lz4 or not at all, got \"bz2\""
    )
    assertEquals(
      errorOf(after(RecordCodec.append(Record.Chunk(0, 0, 3, 5, "", Bytes.utf8("abc")), _))),
      "byte 25: the CRC of the chunk's records, uncompressed, is " +
        "written as 0x00000005, its bytes give 0x352441c2"
    )
    assertEquals(
      errorOf(after(RecordCodec.append(Record.SummaryOffset(3, 0, 0), _))),
      "byte 25: expected a record of the data section, got a Summary Offset record"
    )
    assertEquals(
      errorOf(begin.slice(0, 20)),
      "byte 8: the file is cut off: expected 8 bytes of Header, got 3 bytes"
    )

  test("a record of an unknown kind is returned unchanged"):
    val file = after(RecordCodec.append(Record.Other(0x91, Bytes.utf8("later")), _))
    assertEquals(Parsing.all(file).records.last, Record.Other(0x91, Bytes.utf8("later")))

  test("a channel may be defined again equally, but not differently"):
    def channel(topic: String) =
      Record.Channel(1, 0, topic, "", scala.collection.immutable.VectorMap.empty)
    def file(second: String) = after: out =>
      RecordCodec.append(channel("/a"), out)
      RecordCodec.append(channel(second), out)
    assertEquals(Parsing.all(file("/a")).records.size, 3)
    assertEquals(errorOf(file("/b")), "byte 52: expected channel 1 as it was named before, /a, got /b")
