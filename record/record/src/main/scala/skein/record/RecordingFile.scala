package skein.record

import java.nio.file.{Files, Path}
import java.sql.{DriverManager, SQLException}
import java.util.Properties
import org.duckdb.DuckDBConnection
import scala.util.{Try, Using}
import skein.units.Expect

/** A recording's database while it is written. For one thread at a time. */
private[record] final class RecordingFile private (val path: Path, connection: DuckDBConnection):
  private var nextRow = 0L
  private var written = Written.nothing
  private var broken  = false

  /** Appends records in order and commits them: they survive a kill of the process from here on, and a power
    * cut once the file is closed.
    */
  def write(records: Seq[Record]): Either[RecordError, Unit] =
    // Data written to a deleted file are lost when it is closed, without any other sign.
    if !Files.exists(path) then
      failed(RecordError.WriteFailed(path, "it was taken away while it was written"))
    else append(records)

  private def append(records: Seq[Record]): Either[RecordError, Unit] =
    RecordingFile.attempt(RecordError.WriteFailed(path, _)):
      val numbered = records.zipWithIndex.map((record, index) => (nextRow + index, record))
      execute("BEGIN")
      for (table, rows) <- numbered.groupBy((_, record) => Table.of(record)) do
        // groupBy has sorted every record to the table of its own type.
        table.asInstanceOf[Table[Record]].append(rows, connection)
      // As SQL: the driver's own commit() reports success when the log cannot be written.
      execute("COMMIT")
      written = written ++ records.map(Table.of(_).name)
      nextRow += records.size
    .left.flatMap(failed)

  private def failed(error: RecordError): Left[RecordError, Nothing] =
    broken = true
    Left(error)

  /** Appends the last record, even after a refused write, if the disk accepts it then. */
  def end(record: Ending): Either[RecordError, Unit] =
    if broken then
      val _ = RecordingFile.attempt(RecordError.WriteFailed(path, _))(execute("ROLLBACK"))
    write(Seq(record))

  /** Moves the write-ahead log into the file, waits until the disk has stored it, and closes the file, even
    * if the log could not be moved.
    */
  def close(): Either[RecordError, Written] =
    RecordingFile.attempt(RecordError.WriteFailed(path, _)):
      Using.resource(connection): _ =>
        execute("SET fsync_mode = 'STANDARD'")
        execute("CHECKPOINT")
      written

  private def execute(sql: String): Unit = Sql.execute(connection, sql)

private[record] object RecordingFile:

  /** Creates the file and its tables and writes the heading. Blocks, for a few hundred milliseconds the first
    * time.
    */
  def create(file: Path, heading: RecordingHeader): Either[RecordError, RecordingFile] =
    free(file).flatMap: _ =>
      attempt(RecordError.CannotCreate(file, _)):
        val connection = connect(file, readOnly = false)
        try
          createTables(connection)
          // A kill of the process loses nothing that the operating system has: no commit waits for the disk.
          Sql.execute(connection, "SET fsync_mode = 'NONE'")
          // Appending leaves nothing to optimise, and each batch would be planned again.
          Sql.execute(connection, "SET enable_optimizer = false")
          RecordingFile(file, connection)
        catch
          case failure: SQLException =>
            val _ = Try(connection.close())
            discard(file)
            throw failure
      .flatMap: opened =>
        val written = opened.write(heading.records)
        if written.isLeft then
          val _ = opened.close()
          discard(file)
        written.map(_ => opened)

  /** Deletes what was begun, for example on a full disk: it would prevent the next attempt. */
  private def discard(file: Path): Unit =
    for ending <- Seq("", ".wal") do
      val _ = Try(Files.deleteIfExists(file.resolveSibling(s"${file.getFileName}$ending")))

  /** Checks whether a recording can have this name; Left says why it cannot. */
  def free(file: Path): Either[RecordError, Unit] =
    if isUnnameable(file) then Left(RecordError.CannotCreate(file, Unnameable))
    else Expect.that(!Files.exists(file))(RecordError.AlreadyExists(file))

  /** Creates the file and its tables; `rows` fills them. Blocks. */
  def filled(file: Path)(rows: DuckDBConnection => Unit): Either[RecordError, Unit] =
    attempt(RecordError.CannotCreate(file, _)):
      Using.resource(connect(file, readOnly = false)): connection =>
        createTables(connection)
        rows(connection)
        Sql.execute(connection, "CHECKPOINT")

  private val Unnameable =
    "expected a path without ';', '?' or '\\', which DuckDB takes for its end, for options or for '/'"

  private def isUnnameable(file: Path) = file.toAbsolutePath.toString.exists(";?\\".contains(_))

  private def createTables(connection: DuckDBConnection): Unit =
    Sql.execute(connection, "CREATE TABLE format (version INTEGER NOT NULL)")
    Sql.execute(connection, s"INSERT INTO format VALUES (${RecordingFormat.version})")
    Table.all.foreach(table => Sql.execute(connection, table.create))

  /** Opens a connection to this file only, with one thread, and without extensions from the network. A new
    * file can be read by every client since DuckDB 1.0.
    */
  def connect(file: Path, readOnly: Boolean): DuckDBConnection =
    if isUnnameable(file) then throw SQLException(Unnameable)
    val properties = Properties()
    properties.setProperty("duckdb.read_only", readOnly.toString)
    properties.setProperty("threads", "1")
    properties.setProperty("storage_compatibility_version", "v1.0.0")
    properties.setProperty("autoinstall_known_extensions", "false")
    // Absolute, since `md:x` or `s3://x` would be a database elsewhere.
    DriverManager
      .getConnection(s"jdbc:duckdb:${file.toAbsolutePath}", properties)
      .asInstanceOf[DuckDBConnection]

  /** Runs an action on the database; its exceptions become an error with the first line of their text. */
  def attempt[A](error: String => RecordError)(action: => A): Either[RecordError, A] =
    try Right(action)
    catch
      case failed: SQLException => Left(error(firstLine(failed.getMessage)))
      // Libraries are unpacked into the folder for temporary files, which may be full or refuse them.
      case failed: LinkageError =>
        val causes  = Iterator.iterate[Throwable](failed)(_.getCause).takeWhile(_ != null).toVector
        val library = if causes.exists(isOfZstandard) then "Zstandard's" else "the database's"
        Left(error(s"$library library cannot be loaded: ${firstLine(s"${causes.last.getMessage}")}"))

  private def isOfZstandard(failure: Throwable) =
    s"${failure.getMessage}".contains(Zstandard) ||
      failure.getStackTrace.exists(_.getClassName.startsWith(Zstandard))

  private val Zstandard = "com.github.luben.zstd"

  private def firstLine(message: String): String =
    message.linesIterator.nextOption().getOrElse("no reason given")
