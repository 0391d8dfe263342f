package skein.mcap

/** The byte that states a record's kind. */
object Opcode:
  val Header          = 0x01
  val Footer          = 0x02
  val Schema          = 0x03
  val Channel         = 0x04
  val Message         = 0x05
  val Chunk           = 0x06
  val MessageIndex    = 0x07
  val ChunkIndex      = 0x08
  val Attachment      = 0x09
  val AttachmentIndex = 0x0a
  val Statistics      = 0x0b
  val Metadata        = 0x0c
  val MetadataIndex   = 0x0d
  val SummaryOffset   = 0x0e
  val DataEnd         = 0x0f

  private val names = Vector(
    "Header",
    "Footer",
    "Schema",
    "Channel",
    "Message",
    "Chunk",
    "Message Index",
    "Chunk Index",
    "Attachment",
    "Attachment Index",
    "Statistics",
    "Metadata",
    "Metadata Index",
    "Summary Offset",
    "Data End"
  )

  def name(opcode: Int): String = names.lift(opcode - 1).getOrElse(s"record of kind 0x${Hex.ofByte(opcode)}")

  /** Whether the specification defines the opcode; readers skip all others except 0x00, which is invalid. */
  def isKnown(opcode: Int): Boolean = opcode >= Header && opcode <= DataEnd

  def isOfData(opcode: Int): Boolean    = dataSection(opcode) || !isKnown(opcode)
  def isOfSummary(opcode: Int): Boolean = summarySection(opcode) || !isKnown(opcode)
  def isOfChunk(opcode: Int): Boolean   =
    opcode == Schema || opcode == Channel || opcode == Message || !isKnown(opcode)

  private val dataSection = Set(Schema, Channel, Message, Attachment, Chunk, MessageIndex, Metadata, DataEnd)

  private val summarySection =
    Set(Schema, Channel, ChunkIndex, AttachmentIndex, Statistics, MetadataIndex, SummaryOffset, Footer)
