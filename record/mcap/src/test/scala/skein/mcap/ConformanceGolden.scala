package skein.mcap

import java.util.HexFormat
import scala.collection.immutable.VectorMap
import scala.io.Source

/** The pairs of the specification's own conformance suite, 312 of its 416: a file's content, as JSON, and its
  * bytes. A line of `conformance.jsonl` is a pair: its name, the features it uses, its records, and the file
  * in hexadecimal digits.
  */
class ConformanceGolden extends munit.FunSuite:
  import ConformanceGolden.*

  private val pairs =
    val source = Source.fromResource("conformance.jsonl")
    try source.getLines().map(line => Pair(ujson.read(line))).toVector
    finally source.close()

  test("all pairs of the suite are present"):
    assertEquals(pairs.size, 312)
    assertEquals(pairs.map(_.name).distinct.size, 312)

  test("every file is read as the records in its description"):
    pairs.foreach: pair =>
      val read = Parsing.all(pair.file)
      assertEquals(read.end, Parsed.Ended, pair.name)
      assertEquals(read.records.filterNot(isHidden), pair.records, pair.name)

  test("every file is read equally when its bytes arrive one by one"):
    pairs.foreach: pair =>
      val read = Parsing.all(pair.file, piece = 1)
      assertEquals(read.end, Parsed.Ended, pair.name)
      assertEquals(read.records.filterNot(isHidden), pair.records, pair.name)

  test("every file without padding is written byte for byte"):
    val written = pairs.filterNot(_.features("pad"))
    written.foreach(pair => assertEquals(hex(write(pair)), hex(pair.file), pair.name))
    assertEquals(written.size, 153)

  test("a padded file is written without its padding, and otherwise byte for byte"):
    pairs.filter(_.features("pad")).foreach: pair =>
      val plain = pair.name.replace("-pad", "")
      pairs.find(_.name == plain).foreach(other => assertEquals(hex(write(pair)), hex(other.file), pair.name))

  test("every record is encoded as it was decoded"):
    pairs.foreach: pair =>
      Parsing.all(pair.file).records.foreach: record =>
        val out = ByteBuilder(64)
        RecordCodec.append(record, out)
        val again =
          RecordCodec.decode(out.array(0) & 0xff, out.array, 9, out.size, Place(0))
        assertEquals(again, record, pair.name)

  /** Whether a file's description leaves a record out, as it does for chunks and their indexes. */
  private def isHidden(record: Record) =
    record.opcode == Opcode.Chunk || record.opcode == Opcode.MessageIndex

  private def write(pair: Pair): Bytes =
    val has     = pair.features
    val options = WriterOptions(
      library = "",
      chunked = has("ch"),
      compression = Compression.Uncompressed,
      messageIndex = has("mx"),
      chunkIndex = has("chx"),
      statistics = has("st"),
      repeatSchemas = has("rsh"),
      repeatChannels = has("rch"),
      attachmentIndex = has("ax"),
      metadataIndex = has("mdx"),
      summaryOffsets = has("sum")
    )
    val sink   = MemorySink()
    val writer = McapWriter(sink, options)
    pair.records.takeWhile(_.opcode != Opcode.DataEnd).foreach:
      case _: Record.Header                        => ()
      case Record.Schema(id, name, encoding, data) => assertEquals(writer.schema(name, encoding, data), id)
      case Record.Channel(id, schema, topic, encoding, metadata) =>
        assertEquals(writer.channel(topic, encoding, schema, metadata), id)
      case Record.Message(channel, sequence, logTime, publishTime, data) =>
        writer.message(channel, sequence, logTime, publishTime, data)
      case Record.Attachment(logTime, createTime, name, mediaType, data, _) =>
        writer.attachment(logTime, createTime, name, mediaType, data)
      case Record.Metadata(name, metadata) => writer.metadata(name, metadata)
      case other                           => fail(s"$other in the data section of ${pair.name}")
    writer.finish()
    sink.bytes

private object ConformanceGolden:
  def hex(bytes: Bytes): String = HexFormat.of.formatHex(bytes.toArray)

  final case class Pair(name: String, features: Set[String], records: Vector[Record], file: Bytes)

  object Pair:
    def apply(json: ujson.Value): Pair = Pair(
      json("name").str,
      json("features").arr.map(_.str).toSet,
      json("records").arr.map(record).toVector,
      Bytes.of(HexFormat.of.parseHex(json("file").str))
    )

  private def record(json: ujson.Value): Record =
    val fields                = json("fields").arr.map(field => field(0).str -> field(1)).toMap
    def text(name: String)    = fields(name).str
    def long(name: String)    = java.lang.Long.parseUnsignedLong(fields(name).str)
    def int(name: String)     = long(name).toInt
    def bytes(name: String)   = Bytes.of(fields(name).arr.map(_.str.toInt.toByte).toArray)
    def strings(name: String) = fields(name).obj.map((key, value) => key -> value.str).to(VectorMap)
    def numbers(name: String) =
      fields(name).obj.map((key, value) => key.toInt -> value.str.toLong).to(VectorMap)
    json("type").str match
      case "Header" => Record.Header(text("profile"), text("library"))
      case "Footer" =>
        Record.Footer(long("summary_start"), long("summary_offset_start"), int("summary_crc"))
      case "Schema"  => Record.Schema(int("id"), text("name"), text("encoding"), bytes("data"))
      case "Channel" =>
        Record.Channel(
          int("id"),
          int("schema_id"),
          text("topic"),
          text("message_encoding"),
          strings("metadata")
        )
      case "Message" =>
        Record.Message(
          int("channel_id"),
          int("sequence"),
          long("log_time"),
          long("publish_time"),
          bytes("data")
        )
      case "ChunkIndex" =>
        Record.ChunkIndex(
          long("message_start_time"),
          long("message_end_time"),
          long("chunk_start_offset"),
          long("chunk_length"),
          numbers("message_index_offsets"),
          long("message_index_length"),
          text("compression"),
          long("compressed_size"),
          long("uncompressed_size")
        )
      case "Attachment" =>
        val attachment = Record.Attachment(
          long("log_time"),
          long("create_time"),
          text("name"),
          text("media_type"),
          bytes("data"),
          0
        )
        // The description leaves the CRC out; the parser has verified it.
        val out = ByteBuilder(64)
        RecordCodec.append(attachment, out)
        RecordCodec.decode(Opcode.Attachment, out.array, 9, out.size, Place(0))
      case "AttachmentIndex" =>
        Record.AttachmentIndex(
          long("offset"),
          long("length"),
          long("log_time"),
          long("create_time"),
          long("data_size"),
          text("name"),
          text("media_type")
        )
      case "Statistics" =>
        Record.Statistics(
          long("message_count"),
          int("schema_count"),
          int("channel_count"),
          int("attachment_count"),
          int("metadata_count"),
          int("chunk_count"),
          long("message_start_time"),
          long("message_end_time"),
          numbers("channel_message_counts")
        )
      case "Metadata"      => Record.Metadata(text("name"), strings("metadata"))
      case "MetadataIndex" => Record.MetadataIndex(long("offset"), long("length"), text("name"))
      case "SummaryOffset" =>
        Record.SummaryOffset(int("group_opcode"), long("group_start"), long("group_length"))
      case "DataEnd" => Record.DataEnd(int("data_section_crc"))
      case other     => throw IllegalArgumentException(other)
