package skein.mcap

import java.util.SplittableRandom
import scala.collection.immutable.VectorMap

/** A random file, with the records that were written into it. */
final case class RandomFile(
    seed: Long,
    options: WriterOptions,
    bytes: Bytes,
    messages: Vector[Record.Message],
    channels: Map[Int, Record.Channel],
    schemas: Map[Int, Record.Schema],
    attachments: Vector[Record.Attachment],
    metadata: Vector[Record.Metadata]
):
  def show: String = s"seed $seed, ${bytes.size} bytes, $options"

  def byTime: Vector[Record.Message] =
    messages.sortWith((a, b) => java.lang.Long.compareUnsigned(a.logTime, b.logTime) < 0)

object RandomFile:

  /** @param most maximum number of messages */
  def draw(seed: Long, most: Int = 60, options: SplittableRandom => WriterOptions = anyOptions): RandomFile =
    val random      = SplittableRandom(seed)
    val chosen      = options(random)
    val sink        = MemorySink()
    val writer      = McapWriter(sink, chosen)
    val messages    = Vector.newBuilder[Record.Message]
    val attachments = Vector.newBuilder[Record.Attachment]
    val metadata    = Vector.newBuilder[Record.Metadata]
    var schemas     = Map.empty[Int, Record.Schema]
    var channels    = Map.empty[Int, Record.Channel]
    var time        = random.nextLong(1L << 40)
    for step <- 0 until random.nextInt(most) do
      random.nextInt(12) match
        case 0 =>
          val schema = Record.Schema(0, text(random), text(random), data(random))
          val id     = writer.schema(schema.name, schema.encoding, schema.data)
          schemas += id -> schema.copy(id = id)
        case 1 =>
          val schema  = random.nextInt(schemas.size + 1)
          val channel = Record.Channel(0, schema, s"/${random.nextInt(4)}", text(random), strings(random))
          val id      = writer.channel(channel.topic, channel.messageEncoding, schema, channel.metadata)
          channels += id -> channel.copy(id = id)
        case 2 =>
          val attachment =
            Record.Attachment(time, random.nextLong(), text(random), text(random), data(random), 0)
          import attachment.*
          writer.attachment(logTime, createTime, name, mediaType, attachment.data)
          attachments += attachment
        case 3 =>
          val record = Record.Metadata(text(random), strings(random))
          writer.metadata(record.name, record.metadata)
          metadata += record
        case 4 if random.nextInt(4) == 0 => writer.flush()
        case _ if channels.nonEmpty      =>
          // Mostly forward, sometimes back, and sometimes two at equal times.
          time = (time + random.nextLong(-300, 1000).max(-time)).max(0)
          val channel = 1 + random.nextInt(channels.size)
          val message = Record.Message(channel, step, time, time - random.nextInt(5), data(random))
          writer.message(channel, step, message.logTime, message.publishTime, message.data)
          messages += message
        case _ => ()
    writer.finish()
    RandomFile(
      seed,
      chosen,
      sink.bytes,
      messages.result(),
      channels,
      schemas,
      attachments.result(),
      metadata.result()
    )

  /** Options with everything that makes the whole file accessible by its index. */
  def indexed(random: SplittableRandom): WriterOptions =
    WriterOptions(chunkBytes = 1 + random.nextInt(600), compression = compression(random))

  def anyOptions(random: SplittableRandom): WriterOptions =
    def even() = random.nextInt(2) == 0
    WriterOptions(
      text(random),
      text(random),
      random.nextInt(4) > 0,
      1 + random.nextInt(600),
      compression(random),
      even(),
      even(),
      even(),
      even(),
      even(),
      even(),
      even(),
      even()
    )

  private def compression(random: SplittableRandom) = random.nextInt(3) match
    case 0 => Compression.Uncompressed
    case 1 => Compression.Lz4
    case _ => Compression.Zstd(1 + random.nextInt(3))

  private def text(random: SplittableRandom) =
    Vector("", "a", "pose", "größer", "\u0000", "🛸 x").apply(random.nextInt(6))

  private def strings(random: SplittableRandom) =
    (0 until random.nextInt(3)).map(at => s"$at" -> text(random)).to(VectorMap)

  private def data(random: SplittableRandom) =
    val array = new Array[Byte](random.nextInt(80))
    if random.nextInt(2) == 0 then random.nextBytes(array)
    Bytes.of(array)
