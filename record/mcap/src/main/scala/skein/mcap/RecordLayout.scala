package skein.mcap

import scala.collection.immutable.SeqMap
import scala.deriving.Mirror

/** The layout of one field of a record, with its name in the specification. */
private[mcap] final class RecordField[A] private (val write: (A, ByteBuilder) => Unit, val read: Fields => A)

private[mcap] object RecordField:
  def u8(name: String): RecordField[Int]        = RecordField((value, out) => out.u8(value), _.u8(name))
  def u16(name: String): RecordField[Int]       = RecordField((value, out) => out.u16(value), _.u16(name))
  def u32(name: String): RecordField[Int]       = RecordField((value, out) => out.u32(value), _.u32(name))
  def u64(name: String): RecordField[Long]      = RecordField((value, out) => out.u64(value), _.u64(name))
  def string(name: String): RecordField[String] =
    RecordField((value, out) => out.string(value), _.string(name))

  def bytes32(name: String): RecordField[Bytes] = RecordField(
    (value, out) =>
      out.u32(value.size)
      out.raw(value)
    ,
    _.bytes32(name)
  )

  def strings(name: String): RecordField[SeqMap[String, String]] = RecordField(
    (value, out) =>
      out.counted:
        for (key, text) <- value do
          out.string(key)
          out.string(text)
    ,
    _.strings(name)
  )

  def numbers(name: String): RecordField[SeqMap[Int, Long]] = RecordField(
    (value, out) =>
      out.counted:
        for (key, number) <- value do
          out.u16(key)
          out.u64(number)
    ,
    _.numbers(name)
  )

/** The layout of a kind of record: its fields in order. */
private[mcap] final class RecordLayout[A <: Record](fields: Vector[RecordField[Any]], make: Product => A):
  def write(record: Product, out: ByteBuilder): Unit =
    for index <- fields.indices do fields(index).write(record.productElement(index), out)

  def read(from: Fields): A = make(Tuple.fromArray(fields.map(_.read(from)).toArray))

private[mcap] object RecordLayout:
  import RecordField.*

  /** Layouts by opcode, for kinds that consist only of their fields. */
  val plain: Map[Int, RecordLayout[?]] = Map(
    Opcode.Header -> of[Record.Header]((string("profile"), string("library"))),
    Opcode.Footer -> of[Record.Footer]((
      u64("summary_start"),
      u64("summary_offset_start"),
      u32("summary_crc")
    )),
    Opcode.Schema  -> of[Record.Schema]((u16("id"), string("name"), string("encoding"), bytes32("data"))),
    Opcode.Channel -> of[Record.Channel]((
      u16("id"),
      u16("schema_id"),
      string("topic"),
      string("message_encoding"),
      strings("metadata")
    )),
    Opcode.MessageIndex -> of[Record.MessageIndex]((u16("channel_id"), bytes32("records"))),
    Opcode.ChunkIndex   -> of[Record.ChunkIndex]((
      u64("message_start_time"),
      u64("message_end_time"),
      u64("chunk_start_offset"),
      u64("chunk_length"),
      numbers("message_index_offsets"),
      u64("message_index_length"),
      string("compression"),
      u64("compressed_size"),
      u64("uncompressed_size")
    )),
    Opcode.AttachmentIndex -> of[Record.AttachmentIndex]((
      u64("offset"),
      u64("length"),
      u64("log_time"),
      u64("create_time"),
      u64("data_size"),
      string("name"),
      string("media_type")
    )),
    Opcode.Statistics -> of[Record.Statistics]((
      u64("message_count"),
      u16("schema_count"),
      u32("channel_count"),
      u32("attachment_count"),
      u32("metadata_count"),
      u32("chunk_count"),
      u64("message_start_time"),
      u64("message_end_time"),
      numbers("channel_message_counts")
    )),
    Opcode.Metadata      -> of[Record.Metadata]((string("name"), strings("metadata"))),
    Opcode.MetadataIndex -> of[Record.MetadataIndex]((u64("offset"), u64("length"), string("name"))),
    Opcode.SummaryOffset -> of[Record.SummaryOffset](
      (u8("group_opcode"), u64("group_start"), u64("group_length"))
    ),
    Opcode.DataEnd -> of[Record.DataEnd](Tuple1(u32("data_section_crc")))
  )

  private def of[A <: Record](using
      mirror: Mirror.ProductOf[A]
  )(
      fields: Tuple.Map[mirror.MirroredElemTypes, RecordField]
  ): RecordLayout[A] =
    RecordLayout(fields.toList.asInstanceOf[List[RecordField[Any]]].toVector, mirror.fromProduct)
