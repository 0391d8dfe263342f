package skein.mcap

import scala.collection.mutable
import scala.reflect.ClassTag

/** Reads messages by time and topic, attachments and metadata by their index, from a source that can be read
  * anywhere. It opens the chunks that may hold what is asked for and no others. Where a file says too little
  * about itself, or is cut off, `open` reads it through once.
  *
  * Every chunk that is opened is held to its CRC and to what the index says of it. Memory: the summary, and
  * the chunks whose times overlap, uncompressed, within the limits.
  */
final class IndexedReader private (source: ByteSource, limits: McapLimits, val summary: Summary):

  /** The messages asked for. After an error it ends. */
  def messages(query: Query = Query()): Iterator[Either[McapError, TopicMessage]] =
    val channels = summary.channels.values
      .filter(channel => query.topics.forall(_(channel.topic)))
      .map(channel => channel.id -> (channel, summary.schemas.get(channel.schemaId)))
      .toMap
    val wanted  = summary.stretches.filter(query.wants(_, channels.keySet))
    val reading = query.order match
      case Query.Order.File => InFileOrder(wanted, query, channels.contains)
      case ordered => InTimeOrder(wanted, query, channels.contains, ordered == Query.Order.LatestFirst)
    Guarded(() => reading.next()).map(_.map { message =>
      val (channel, schema) = channels(message.channelId)
      TopicMessage(channel, schema, message)
    })

  def attachment(index: Record.AttachmentIndex): Either[McapError, Record.Attachment] =
    Refused.either(one[Record.Attachment](index.offset, index.length, "an attachment"))

  def metadata(index: Record.MetadataIndex): Either[McapError, Record.Metadata] =
    Refused.either(one[Record.Metadata](index.offset, index.length, "metadata"))

  private def part(offset: Long, length: Long): Bytes =
    limits.hold(length, limits.recordBytes, "a record", Place(offset))
    source.read(offset, length.toInt)

  /** The record of which an index says where it is and how long. */
  private def one[A <: Record: ClassTag](offset: Long, length: Long, what: String): A =
    val at   = Place(offset)
    val walk = RecordWalk(part(offset, length), offset, inChunk = false)
    if !walk.step() || walk.length != length then
      Refused.malformed(at, s"a record of $length bytes", s"one of ${walk.length}")
    walk.record match
      case found: A => found
      case other    => Refused.malformed(at, what, s"a ${Opcode.name(other.opcode)} record")

  /** The records of a stretch, message by message. */
  private def open(stretch: Stretch): RecordWalk =
    val at = Place(stretch.offset)
    stretch.kind match
      case Stretch.Kind.Loose =>
        RecordWalk(
          source.read(stretch.offset, Math.toIntExact(stretch.length)),
          stretch.offset,
          inChunk = false
        )
      case Stretch.Kind.Chunk =>
        val chunk = one[Record.Chunk](stretch.offset, stretch.length, "a chunk")
        RecordWalk(Compression.decompress(chunk, limits, at), stretch.offset, inChunk = true)
      case Stretch.Kind.CutChunk =>
        val content = part(stretch.offset + 9, stretch.length - 9).toArray
        val chunk   = RecordCodec.beginningOfChunk(content, content.length, at)
        val records = chunk.fold(Bytes.empty)(Compression.decompress(_, limits, at, cut = true))
        RecordWalk(records, stretch.offset, inChunk = true, cut = true)

  private def hold(time: Long, stretch: Stretch, at: Place): Unit =
    if java.lang.Long.compareUnsigned(time, stretch.startTime) < 0 ||
      java.lang.Long.compareUnsigned(time, stretch.endTime) > 0
    then
      val between = s"${stretch.startTime} and ${stretch.endTime}"
      Refused.malformed(at, s"a log time between $between, as the index says", s"$time")

  private def message(walk: RecordWalk): Record.Message = walk.record match
    case message: Record.Message => message
    case other                   => throw AssertionError(other)

  private trait Reading:
    /** The next, or null. */
    def next(): Record.Message | Null

  private final class InFileOrder(wanted: Vector[Stretch], query: Query, ofChannel: Int => Boolean)
      extends Reading:
    private val left = wanted.iterator
    private var open = Option.empty[(Stretch, RecordWalk)]

    def next(): Record.Message | Null =
      var found: Record.Message | Null = null
      var more                         = true
      while found == null && more do
        open match
          case Some((stretch, walk)) if walk.step() =>
            if walk.isMessage then
              hold(walk.logTime, stretch, walk.place)
              if ofChannel(walk.channelId) && query.wants(walk.logTime) then found = message(walk)
          case _ =>
            more = left.hasNext
            if more then
              val stretch = left.next()
              open = Some(stretch -> IndexedReader.this.open(stretch))
      found

  /** Opens a stretch once no message that is still to come from those that are open can be earlier than its
    * first.
    */
  private final class InTimeOrder(
      wanted: Vector[Stretch],
      query: Query,
      ofChannel: Int => Boolean,
      latestFirst: Boolean
  ) extends Reading:
    private val sign = if latestFirst then -1 else 1

    private def first(stretch: Stretch) = if latestFirst then stretch.endTime else stretch.startTime

    private val left =
      wanted.sortWith((a, b) =>
        sign * java.lang.Long.compareUnsigned(first(a), first(b)) < 0
      ).iterator.buffered

    private val heads = mutable.PriorityQueue.empty[Opened](using (a, b) => -a.compare(b))
    private var held  = 0L

    def next(): Record.Message | Null =
      while left.hasNext && heads.headOption.forall(head =>
          sign * java.lang.Long.compareUnsigned(first(left.head), head.time) <= 0
        )
      do
        val opened = Opened(left.next())
        if opened.hasNext then
          held += opened.bytes
          if held > limits.openBytes then
            throw Refused(McapError.TooLarge(opened.at, "what overlaps in time", held, limits.openBytes))
          heads += opened
      if heads.isEmpty then null
      else
        val head  = heads.dequeue()
        val found = head.take()
        if head.hasNext then heads += head else held -= head.bytes
        found

    /** The messages of a stretch that are asked for, in order. */
    private final class Opened(stretch: Stretch):
      private val walk      = open(stretch)
      private var positions = new Array[Long](64)
      private var times     = new Array[Long](64)
      private var count     = 0
      private var ordered   = true
      private var taken     = 0

      while walk.step() do
        if walk.isMessage then
          val time = walk.logTime
          hold(time, stretch, walk.place)
          if ofChannel(walk.channelId) && query.wants(time) then
            if count == times.length then
              times = times.padTo(count * 2, 0L)
              positions = positions.padTo(count * 2, 0L)
            ordered &&= count == 0 || java.lang.Long.compareUnsigned(times(count - 1), time) <= 0
            times(count) = time
            positions(count) = walk.start
            count += 1

      /** In order of log time; messages of one time as they stand in the file. */
      private val order: Array[Int] =
        val all = Array.range(0, count)
        if ordered then all
        else
          all.sortWith((a, b) => {
            val by = java.lang.Long.compareUnsigned(times(a), times(b)); by < 0 || by == 0 && a < b
          })

      def at: Place        = Place(stretch.offset)
      def bytes: Long      = walk.size + 20L * count
      def hasNext: Boolean = taken < count

      private def index = order(if latestFirst then count - 1 - taken else taken)

      def time: Long = times(index)

      def compare(that: Opened): Int =
        val byTime = java.lang.Long.compareUnsigned(time, that.time)
        sign * (if byTime != 0 then byTime else java.lang.Long.compare(stretch.offset, that.stretchOffset))

      private def stretchOffset = stretch.offset

      def take(): Record.Message =
        walk.goTo(positions(index).toInt)
        taken += 1
        message(walk)

object IndexedReader:
  /** Finds out what the source holds. */
  def open(source: ByteSource, limits: McapLimits = McapLimits()): Either[McapError, IndexedReader] =
    Refused.either(IndexedReader(source, limits, SummaryReader.read(source, limits)))

/** What `take` gives until it gives null or refuses. */
private final class Guarded[A](take: () => A | Null) extends Iterator[Either[McapError, A]]:
  private var ahead = Option.empty[Either[McapError, A]]
  private var ended = false

  def hasNext: Boolean =
    if ahead.isEmpty && !ended then
      Refused.either(take()) match
        case Left(error) =>
          ahead = Some(Left(error))
          ended = true
        case Right(null)  => ended = true
        case Right(found) => ahead = Some(Right(found.asInstanceOf[A]))
    ahead.isDefined

  def next(): Either[McapError, A] =
    if !hasNext then throw java.util.NoSuchElementException("no more messages")
    val found = ahead.get
    ahead = None
    found
