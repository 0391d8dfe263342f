package skein.record

import java.io.IOException
import java.nio.file.{Files, Path}
import java.sql.Connection
import scala.util.Using

/** Exports recordings for other programs. */
object Export:

  /** Writes each table as `TABLE.parquet` into the folder, which is created if necessary; files of these
    * names are replaced. Rows keep the order in which they were recorded. Blocks.
    *
    * @return the files written
    */
  def parquet(recording: Path, directory: Path): Either[RecordError, Vector[Path]] =
    for
      _     <- createDirectory(recording, directory)
      files <- RecordingReader.withRecording(recording): connection =>
        RecordingFile.attempt(RecordError.ExportFailed(recording, directory, _)):
          Table.all.filterNot(_.isMissing(connection)).map(table =>
            write(table, directory.resolve(table.name + ".parquet"), connection)
          )
    yield files

  private def createDirectory(recording: Path, directory: Path): Either[RecordError, Unit] =
    try
      val _ = Files.createDirectories(directory)
      Right(())
    catch
      case failed: IOException => Left(RecordError.ExportFailed(recording, directory, FileReason.of(failed)))

  private def write(table: Table[?], file: Path, connection: Connection): Path =
    val quoted = "'" + file.toString.replace("'", "''") + "'"
    Using.resource(connection.createStatement()): statement =>
      val _ =
        statement.execute(s"COPY (SELECT * FROM ${table.name} ORDER BY row) TO $quoted (FORMAT parquet)")
    file
