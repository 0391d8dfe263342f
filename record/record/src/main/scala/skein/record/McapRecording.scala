package skein.record

import java.nio.file.{Files, Path, StandardCopyOption}
import java.util.Base64
import org.duckdb.DuckDBConnection
import scala.collection.immutable.VectorMap
import scala.collection.mutable
import skein.mcap.{Bytes, McapWriter, Parsed, Record as McapRecord, WriterOptions}
import skein.mcap.file.McapFile
import skein.scene.Scene
import skein.units.*

/** A recording as an MCAP file, for Foxglove, Lichtblick, PlotJuggler and Rerun, and back.
  *
  * Every row is a message of the topic `/skein/TABLE`, a JSON object by the names of the columns. These
  * messages are the complete recording, and `read` reads them. Only the pixels of an image and the points of
  * a cloud are in the message after the row, a `foxglove.RawImage` or a `foxglove.PointCloud`. Additional
  * messages are views of the rows by Foxglove's schemas ([[FoxgloveViews]]).
  *
  * Times of messages are on the controller's clock, ns. The log time is when the row's fact was known there:
  * a reading was received, a decision made, a command sent or answered. A row without such a time takes that
  * of the row before. The publish time equals it, except for a prediction, when it was made, and for a round
  * trip, when it began. The sampling time of physics is in the message.
  */
object McapRecording:
  private val About  = "skein"
  private val Binary = "protobuf"

  /** Writes or replaces the file. Blocks; holds the whole recording in memory, images and clouds compressed.
    *
    * @param scene makes the scene of the flight's world from the recording's parameters
    */
  def write(
      recording: Path,
      file: Path,
      scene: Map[String, String] => Scene = _ => Scene.Empty
  ): Either[RecordError, Unit] =
    for
      rows <- RecordingReader.records(recording)
      _    <- FileReason.attempt(RecordError.ExportFailed(recording, file, _)):
        if Files.exists(file) && !Files.isRegularFile(file) then
          McapFile.write(file, options)(write(rows, scene, _))
        else
          // An existing file stays until the new one is complete.
          WorkFolder.beside(file): folder =>
            val made = folder.resolve("made.mcap")
            McapFile.write(made, options)(write(rows, scene, _))
            val _ = Files.move(made, file, StandardCopyOption.REPLACE_EXISTING)
    yield ()

  private[record] val options = WriterOptions(library = "skein")

  private def write(
      rows: Vector[(Long, Record)],
      scene: Map[String, String] => Scene,
      mcap: McapWriter
  ): Unit =
    val names  = rows.collect { case (_, vehicle: VehicleRow) => vehicle.name }
    val offset = Some(firstOffset(rows.map(_._2)))
    val flight = Rows(mcap, names, FlightTopics.startOf(rows), offset, sceneOf(rows, scene))
    rows.foreach(flight.put)

  /** The scene of a flight that was recorded in the built-in simulator; an empty scene for other simulators.
    *
    * @param scene makes a scene from the recording's parameters
    */
  def sceneOf(rows: Vector[(Long, Record)], scene: Map[String, String] => Scene): Scene =
    val isOurs = rows.exists:
      case (_, flight: FlightRow) => flight.isBuiltIn
      case _                      => false
    if isOurs then scene(rows.collect { case (_, ParameterRow(name, value)) => name -> value }.toMap)
    else Scene.Empty

  /** The offset from the simulator's clock to the controller's: the first estimate; without any estimate, the
    * first reading is assumed to have no latency.
    */
  private[skein] def firstOffset(rows: Vector[Record]): Span =
    val estimated =
      rows.iterator.collect { case decision: DecisionRow => decision.trueAge.map(_.clockOffset) }.flatten
    val assumed = rows.iterator.collect { case first: ReadingRow =>
      first.state.receivedAt.since(first.state.validAt)
    }
    (estimated ++ assumed).nextOption().getOrElse(Span.Zero)

  /** Writes a flight to a file: immediately its topics and opening messages, then row by row. */
  private[record] final class Rows(
      mcap: McapWriter,
      vehicles: Vector[String],
      from: Instant,
      offset: Option[Span],
      scene: Scene
  ):
    private val topics   = FlightTopics(vehicles, from, offset, scene)
    private val channels = Channels(mcap)
    private val sensors  = mutable.Set.empty[ImagingSensor]

    mcap.metadata(About, VectorMap("format" -> RecordingFormat.version.toString))
    FlightTopics.all(vehicles).foreach(channels.add)
    topics.opening.foreach(channels.put)

    def put(number: Long, record: Record): Unit =
      for sensor <- ImagingSensor.of(record) if sensors.add(sensor) do
        FlightTopics.of(sensor).foreach(channels.add)
      topics.of(number, record).foreach(channels.put)

  private final class Channels(mcap: McapWriter):
    private val schemas  = mutable.Map.empty[String, Int]
    private val channels = mutable.Map.empty[String, Int]
    private val counts   = mutable.Map.empty[Int, Int].withDefaultValue(0)

    def add(topic: Topic): Unit =
      val schema = schemas.getOrElseUpdate(
        topic.schemaName,
        if topic.isBinary then
          mcap.schema(topic.schemaName, Binary, Bytes.of(Base64.getDecoder.decode(topic.schema)))
        else mcap.schema(topic.schemaName, "jsonschema", Bytes.utf8(topic.schema))
      )
      channels(topic.name) = mcap.channel(topic.name, if topic.isBinary then Binary else "json", schema)

    def put(message: FlightMessage): Unit =
      val channel = channels(message.topic)
      mcap.message(
        channel,
        counts(channel),
        message.known.toNanos.max(0),
        message.published.toNanos.max(0),
        Bytes.of(message.bytes)
      )
      counts(channel) += 1

  /** Makes a recording from the output of `write`, with equal contents, and so an equal [[Digest]]. Blocks;
    * needs temporary disk space in the recording's folder for the rows as text.
    */
  def read(file: Path, recording: Path): Either[RecordError, Unit] =
    if Files.isDirectory(file) then Left(RecordError.NotAnExport(file, "it is a folder"))
    else if !Files.isRegularFile(file) then Left(RecordError.NoSuchFile(file))
    else
      RecordingFile.free(recording).flatMap: _ =>
        imported(file, recording)

  private def imported(file: Path, recording: Path): Either[RecordError, Unit] =
    FileReason.attempt(RecordError.CannotCreate(recording, _)):
      WorkFolder.beside(recording): folder =>
        val made = folder.resolve("recording.duckdb")
        for
          tables <- gather(file, folder)
          _      <- RecordingFile.filled(made)(connection => tables.foreach(insert(_, connection))).left.map:
            case RecordError.CannotCreate(_, reason) => RecordError.NotAnExport(file, reason)
            case other                               => other
          _ <- RecordingReader.read(made).left.map:
            case RecordError.NotARecording(_, reason) => RecordError.NotAnExport(file, reason)
            case other                                => other
        yield
          val _ = Files.move(made, recording)
    .flatten

  /** Writes the rows of each table that has any to a JSON file, a row a line, and measures the longest. */
  private def gather(file: Path, folder: Path): Either[RecordError, Vector[Gathered]] =
    McapFile.stream(file): records =>
      val outs = mutable.LinkedHashMap.empty[String, RowsFile]
      // A row whose bytes have not been read yet.
      var waiting              = Option.empty[(table: String, row: String)]
      var format               = RecordingFormat.version
      def refused(why: String) = Some(RecordError.NotAnExport(file, why))
      def lacking(row: String) = refused(s"an image or a cloud has no bytes behind its row: ${row.take(100)}")
      def out(table: String)   = outs.getOrElseUpdate(table, RowsFile(folder.resolve(s"$table.json")))
      def row(message: McapRecord.Message, topic: String) =
        val name = topic.drop(FlightTopics.Prefix.length)
        (tables.get(name), waiting) match
          case (None, _)              => refused(s"its topic $topic is none of a recording's tables")
          case (_, Some((_, before))) => lacking(before)
          case (Some(table), _)       =>
            val text = message.data.utf8
            if table.columns.definitions.exists(_.isBlob) then waiting = Some((name, text))
            else out(name).line(text)
            None
      def bytes(message: McapRecord.Message, topic: String) = waiting match
        case Some((table, row)) if isOf(table, topic) =>
          Protobuf.bytesOf(message.data, BytesField) match
            case None       => lacking(row)
            case Some(data) =>
              val packed = Base64.getEncoder.encodeToString(Blob.of(data.toArray).packed)
              val blob   = tables(table).columns.definitions.last.name
              out(table).line(s"${row.stripSuffix("}")},${Json.string(blob)}:${Json.string(packed)}}")
              waiting = None
              None
        case _ => None
      try
        val failed = records
          .flatMap:
            case Left(error)                                              => refused(error.message)
            case Right(Parsed.Found(metadata: McapRecord.Metadata, _, _)) =>
              formatOf(metadata).flatMap: found =>
                format = found
                otherFormat(file, found)
            case Right(Parsed.Found(message: McapRecord.Message, _, _)) =>
              val topic = records.channel(message.channelId).fold("")(_.topic)
              if topic.startsWith(FlightTopics.Prefix) then row(message, topic) else bytes(message, topic)
            case Right(_) => None
          .nextOption()
          .orElse(waiting.flatMap((_, row) => lacking(row)))
        failed.toLeft(
          outs.map((name, lines) => Gathered(tables(name), lines.file, lines.longest, format)).toVector
        )
      finally outs.values.foreach(_.close())

  /** Whether messages of this topic contain the bytes of a table's row. */
  private def isOf(table: String, topic: String) =
    topic.endsWith(if table == Table.cloud.name then "/cloud" else "/image")

  /** The number of the field `data` in both messages. */
  private val BytesField = ImageEncoding.RawImageData.ensuring(_ == ImageEncoding.PointCloudData)

  /** @param longest approximate length of the longest line, bytes
    * @param format version of the exported recording's tables
    */
  private final case class Gathered(table: Table[?], file: Path, longest: Int, format: Int)

  private final class RowsFile(val file: Path) extends AutoCloseable:
    private val out = Files.newBufferedWriter(file)
    var longest     = 0

    def line(text: String): Unit =
      longest = longest.max(text.length * 3)
      out.write(text)
      out.newLine()

    def close(): Unit = out.close()

  private val tables: Map[String, Table[?]] = Table.all.map(table => table.name -> table).toMap

  private def formatOf(metadata: McapRecord.Metadata): Option[Int] =
    metadata.metadata.get("format").filter(_ => metadata.name == About).flatMap(_.toIntOption)

  private def otherFormat(file: Path, found: Int): Option[RecordError] =
    Option.when(found < RecordingFormat.oldest || found > RecordingFormat.version):
      RecordError.OtherVersion(file, RecordingFormat.oldest, RecordingFormat.version, found)

  private def insert(rows: Gathered, connection: DuckDBConnection): Unit =
    val table   = rows.table
    val columns = table.numbered
    val types   =
      columns.map(column => s"${column.name}: '${if column.isBlob then "VARCHAR" else column.sqlType}'")
        .mkString("{", ", ", "}")
    val values = columns.map: column =>
      if column.isBlob then s"from_base64(${column.name})"
      else if column.nullable && rows.format < RecordingFormat.version then
        column.older.fold(column.name)(older => s"coalesce(${column.name}, $older)")
      else column.name
    val longest = rows.longest.max(JsonLine)
    Sql.execute(
      connection,
      s"INSERT INTO ${table.name} SELECT ${values.mkString(", ")} FROM " +
        // A folder named `a=b` would be a column.
        s"read_json(${Sql.quoted(rows.file.toString)}, format = 'newline_delimited', " +
        s"hive_partitioning = false, columns = $types, maximum_object_size = $longest)"
    )

  /** DuckDB's own limit on the length of a line, bytes. */
  private val JsonLine = 16 * 1024 * 1024
