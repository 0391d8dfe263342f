package skein.mcap

/** What a file holds and where.
  *
  * @param chunks in the order of the file
  * @param stretches where messages are, in the order of the file
  * @param rebuilt whether the file had to be read through for it, since it says too little about itself
  * @param cut where the file is cut off, if it is
  */
final case class Summary(
    header: Record.Header,
    schemas: Map[Int, Record.Schema],
    channels: Map[Int, Record.Channel],
    statistics: Option[Record.Statistics],
    attachments: Vector[Record.AttachmentIndex],
    metadata: Vector[Record.MetadataIndex],
    stretches: Vector[Stretch],
    rebuilt: Boolean,
    cut: Option[McapError]
):
  /** By their names; several channels may share one. */
  def topics: Set[String] = channels.values.map(_.topic).toSet

  def messageCount: Option[Long] = statistics.map(_.messageCount)

/** A part of a file that holds messages.
  *
  * @param channels those that have messages in it; none where that is not known
  */
final case class Stretch(
    offset: Long,
    length: Long,
    startTime: Long,
    endTime: Long,
    channels: Option[Set[Int]],
    kind: Stretch.Kind
)

object Stretch:
  enum Kind:
    /** One chunk. */
    case Chunk

    /** The last chunk of a file that is cut off within it. */
    case CutChunk

    /** Messages that are in no chunk, and what lies between them. */
    case Loose
