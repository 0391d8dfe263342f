package skein.record

import java.io.IOException
import java.nio.file.{Files, Path, StandardCopyOption}
import org.duckdb.DuckDBConnection
import scala.collection.immutable.VectorMap
import scala.collection.mutable
import scala.util.Using
import skein.mcap.{Bytes, McapWriter, Parsed, Record as McapRecord, WriterOptions}
import skein.mcap.file.McapFile
import skein.units.*

/** A recording as an MCAP file, for Foxglove, Lichtblick, PlotJuggler and Rerun, and back.
  *
  * Every row is a message of the topic `/skein/TABLE`, a JSON object by the names of the columns; these are the recording
  * in full, and what `read` reads. Beside them stand views of the same rows by Foxglove's schemas ([[FoxgloveViews]]).
  *
  * Times of messages are on the controller's clock, ns. The log time is when the row's fact was known there: a reading
  * was received, a decision made, a command sent or answered; of a row that says no such time, that of the row before. The
  * publish time is the same, but for a prediction when it was made, and for a round trip when it began. When physics was
  * sampled is in the message.
  */
object McapRecording:
  private val About = "skein"

  /** Writes the file, or replaces it. Blocks; holds the whole recording in memory. */
  def write(recording: Path, file: Path): Either[RecordError, Unit] =
    for
      rows <- RecordingReader.records(recording)
      _    <- attempt(RecordError.ExportFailed(file, _)):
        if Files.exists(file) && !Files.isRegularFile(file) then McapFile.write(file, options)(write(rows, _))
        else
          // What was there stays until all of the new file is.
          val folder = Files.createTempDirectory(file.toAbsolutePath.getParent, ".skein")
          val made   = folder.resolve("made.mcap")
          try
            McapFile.write(made, options)(write(rows, _))
            val _ = Files.move(made, file, StandardCopyOption.REPLACE_EXISTING)
          finally
            val _ = Files.deleteIfExists(made)
            Files.delete(folder)
    yield ()

  private[record] val options = WriterOptions(library = "skein")

  private def write(rows: Vector[(Long, Record)], mcap: McapWriter): Unit =
    val names = rows.collect { case (_, vehicle: Vehicle) => vehicle.name }
    val from  =
      rows.iterator.flatMap((_, record) => FlightTopics.knownAt(record)).nextOption().getOrElse(
        Instant.ofNanos(0)
      )
    val flight = Rows(mcap, names, from, Some(firstOffset(rows)))
    rows.foreach(flight.put)

  /** From the simulator's clock to the controller's: the first estimate, or as if the first reading had taken no time. */
  private def firstOffset(rows: Vector[(Long, Record)]): Span =
    val estimated =
      rows.iterator.collect { case (_, decision: Decision) => decision.trueAge.map(_.clockOffset) }.flatten
    val assumed = rows.iterator.collect { case (_, first: Reading) =>
      first.state.receivedAt.since(first.state.validAt)
    }
    (estimated ++ assumed).nextOption().getOrElse(Span.Zero)

  /** A flight in a file: its topics, and what is there before the first row, at once; then row by row. */
  private[record] final class Rows(
      mcap: McapWriter,
      vehicles: Vector[String],
      from: Instant,
      offset: Option[Span]
  ):
    private val topics   = FlightTopics(vehicles, from, offset)
    private val channels = Channels(mcap)

    mcap.metadata(About, VectorMap("format" -> RecordingFormat.version.toString))
    FlightTopics.all(vehicles).foreach(channels.add)
    topics.opening.foreach(channels.put)

    def put(number: Long, record: Record): Unit = topics.of(number, record).foreach(channels.put)

  private final class Channels(mcap: McapWriter):
    private val schemas  = mutable.Map.empty[String, Int]
    private val channels = mutable.Map.empty[String, Int]
    private val counts   = mutable.Map.empty[Int, Int].withDefaultValue(0)

    def add(topic: Topic): Unit =
      val schema = schemas.getOrElseUpdate(
        topic.schemaName,
        mcap.schema(topic.schemaName, "jsonschema", Bytes.utf8(topic.schema))
      )
      channels(topic.name) = mcap.channel(topic.name, "json", schema)

    def put(message: FlightMessage): Unit =
      val channel = channels(message.topic)
      mcap.message(
        channel,
        counts(channel),
        message.known.toNanos.max(0),
        message.published.toNanos.max(0),
        Bytes.utf8(message.json)
      )
      counts(channel) += 1

  /** Makes a recording of what `write` wrote; equal contents, so an equal [[Digest]]. Blocks; needs room for the rows as
    * text beside the recording meanwhile.
    */
  def read(file: Path, recording: Path): Either[RecordError, Unit] =
    if Files.isDirectory(file) then Left(RecordError.NotARecording(file, "it is a folder"))
    else if !Files.isRegularFile(file) then Left(RecordError.NoSuchFile(file))
    else if Files.exists(recording) then Left(RecordError.AlreadyExists(recording))
    else
      attempt(RecordError.CannotCreate(recording, _)):
        val folder = Files.createTempDirectory(recording.toAbsolutePath.getParent, ".skein")
        try
          val made = folder.resolve("recording.duckdb")
          for
            tables <- gather(file, folder)
            _ <- RecordingFile.filled(made)(connection => tables.foreach(insert(_, connection))).left.map:
              case RecordError.CannotCreate(_, reason) => RecordError.NotARecording(file, reason)
              case other                               => other
            _ <- RecordingReader.read(made).left.map:
              case RecordError.NotARecording(_, reason) => RecordError.NotARecording(file, reason)
              case other                                => other
          yield
            val _ = Files.move(made, recording)
        finally
          Using.resource(
            Files.walk(folder)
          )(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
      .flatten

  /** The rows of each table that has any, as a file of JSON, a row a line. */
  private def gather(file: Path, folder: Path): Either[RecordError, Vector[(Table[?], Path)]] =
    McapFile.stream(file): records =>
      val outs = mutable.LinkedHashMap.empty[String, java.io.BufferedWriter]
      try
        val failed = records
          .flatMap:
            case Left(error) => Some(RecordError.NotARecording(file, error.message))
            case Right(Parsed.Found(metadata: McapRecord.Metadata, _, _)) => otherFormat(file, metadata)
            case Right(Parsed.Found(message: McapRecord.Message, _, _))   =>
              val topic = records.channel(message.channelId).fold("")(_.topic)
              if topic.startsWith(FlightTopics.Prefix) then
                val name = topic.drop(FlightTopics.Prefix.length)
                if tables.contains(name) then
                  val out = outs.getOrElseUpdate(name, Files.newBufferedWriter(folder.resolve(s"$name.json")))
                  out.write(message.data.utf8)
                  out.newLine()
                  None
                else
                  Some(RecordError.NotARecording(file, s"its topic $topic is none of a recording's tables"))
              else None
            case Right(_) => None
          .nextOption()
        failed.toLeft(outs.keys.map(name => tables(name) -> folder.resolve(s"$name.json")).toVector)
      finally outs.values.foreach(_.close())

  private val tables: Map[String, Table[?]] = Table.all.map(table => table.name -> table).toMap

  private def otherFormat(file: Path, metadata: McapRecord.Metadata): Option[RecordError] =
    metadata.metadata
      .get("format")
      .filter(_ => metadata.name == About)
      .flatMap(_.toIntOption)
      .filter(found => found < RecordingFormat.oldest || found > RecordingFormat.version)
      .map(RecordError.OtherVersion(file, RecordingFormat.oldest, RecordingFormat.version, _))

  private def insert(rows: (Table[?], Path), connection: DuckDBConnection): Unit =
    val (table, file) = rows
    val columns       = JsonRow.numbered(table)
    val types         = columns.map(column => s"${column.name}: '${column.sqlType}'").mkString("{", ", ", "}")
    val quoted        = "'" + file.toString.replace("'", "''") + "'"
    Using.resource(connection.createStatement()): statement =>
      val _ = statement.execute(
        s"INSERT INTO ${table.name} SELECT ${columns.map(_.name).mkString(", ")} FROM " +
          s"read_json($quoted, format = 'newline_delimited', columns = $types)"
      )

  private def attempt[A](error: String => RecordError)(action: => A): Either[RecordError, A] =
    try Right(action)
    catch case failed: IOException => Left(error(failed.toString))
